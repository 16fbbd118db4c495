#include "host/message.hpp"

#include "host/json.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <utility>

namespace glim {
namespace {

unsigned byteAt(const std::string& text, std::size_t at) { return at < text.size() ? static_cast<unsigned char>(text[at]) : 0; }

bool isContinuation(unsigned byte) { return (byte & 0xC0U) == 0x80U; }

// The bytes of the character at `at`; 0 if there is a control character, or none of UTF-8 (RFC 3629).
std::size_t lengthOfPrintable(const std::string& text, std::size_t at)
{
    const unsigned first = byteAt(text, at), second = byteAt(text, at + 1);
    if (first < 0x80U) {
        return first >= 0x20U && first != 0x7FU ? 1 : 0;
    }
    const std::size_t length = first >= 0xC2U && first < 0xE0U   ? 2
                               : first >= 0xE0U && first < 0xF0U ? 3
                               : first >= 0xF0U && first < 0xF5U ? 4
                                                                 : 0;
    for (std::size_t i = 1; i < length; ++i) {
        if (!isContinuation(byteAt(text, at + i))) {
            return 0;
        }
    }
    const bool control = first == 0xC2U && second < 0xA0U;
    const bool overlong = (first == 0xE0U && second < 0xA0U) || (first == 0xF0U && second < 0x90U);
    const bool noCharacter = (first == 0xEDU && second > 0x9FU) || (first == 0xF4U && second > 0x8FU);
    return control || overlong || noCharacter ? 0 : length;
}

}  // namespace

std::string escaped(const std::string& text)
{
    std::string result;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t length = lengthOfPrintable(text, at);
        if (length == 0) {
            char code[8];
            std::snprintf(code, sizeof code, "\\x%02x", byteAt(text, at));
            result += code;
        } else {
            result.append(text, at, length);
        }
        at += std::max<std::size_t>(length, 1);
    }
    return result;
}

std::string shortened(const std::string& text)
{
    std::size_t end = 80;
    if (text.size() <= end) {
        return text;
    }
    while (end > 77 && isContinuation(byteAt(text, end))) {
        --end;
    }
    return text.substr(0, end) + "...";
}

std::string inQuotes(const std::string& text) { return '"' + shortened(text) + '"'; }

namespace {

MessageListener messageListener;
MessageForm messageForm = MessageForm::Text;

void printLine(const std::string& line)
{
    constexpr int kPatience = 1000;  // milliseconds
    if (takesMore(STDERR_FILENO, kPatience)) {
        std::cerr << line + '\n';
    }
}

std::string bounded(const std::string& text)
{
    constexpr std::size_t kMax = 8192, kBegin = 6144, kEnd = 1024;
    return escaped(text.size() <= kMax ? text : text.substr(0, kBegin) + " ... " + text.substr(text.size() - kEnd));
}

const char* nameOf(Severity severity) { return severity == Severity::Error ? "error" : severity == Severity::Warning ? "warning" : "note"; }

}  // namespace

std::string toText(MessageId id)
{
#define GLIM_NAME(name) #name,
    constexpr const char* kNames[] = {GLIM_MESSAGE_IDS(GLIM_NAME)};
#undef GLIM_NAME
    std::string text;
    for (const char* c = kNames[static_cast<std::size_t>(id)]; *c != 0; ++c) {
        const bool isCapital = *c >= 'A' && *c <= 'Z';
        text += isCapital && !text.empty() ? "-" : "";
        text += isCapital ? static_cast<char>(*c - 'A' + 'a') : *c;
    }
    return text;
}

namespace part {

MessagePart file(const std::string& path) { return {MessagePart::Kind::File, path, path}; }
MessagePart place(const std::string& place) { return {MessagePart::Kind::Place, place, place}; }
MessagePart value(const std::string& value) { return {MessagePart::Kind::Value, value, value}; }
MessagePart quoted(const std::string& value) { return {MessagePart::Kind::Value, inQuotes(value), value}; }
MessagePart expected(const std::string& what) { return {MessagePart::Kind::Expected, what, what}; }

}  // namespace part

Message::Message(MessageId which, std::initializer_list<MessagePart> words)
    : id(which)
{
    for (const MessagePart& word : words) {
        sentence += word.words;
        std::string* const parts[] = {nullptr, &file, &place, &value, &expected};
        std::string* const named = parts[static_cast<std::size_t>(word.kind)];
        if (named != nullptr && named->empty()) {
            *named = bounded(word.part);
        }
    }
    sentence = bounded(sentence);
}

Message::Message(const Message& inner, std::initializer_list<MessagePart> words)
    : Message(inner.id, words)
{
    for (std::string Message::*member : {&Message::file, &Message::place, &Message::value, &Message::expected}) {
        if ((this->*member).empty()) {
            this->*member = inner.*member;
        }
    }
}

bool takesMore(int file, int milliseconds)
{
    pollfd poll{file, POLLOUT, 0};
    return ::poll(&poll, 1, milliseconds) > 0 && (poll.revents & POLLOUT) != 0;
}

void setMessageForm(MessageForm form) { messageForm = form; }

std::string toLine(Severity severity, const Message& message)
{
    if (messageForm == MessageForm::Text) {
        return "glim: " + message.sentence;
    }
    Json line{{"severity", nameOf(severity)}};
    line.update(toJson(message));
    line.set("sentence", message.sentence);
    return line.dump();
}

void say(Severity severity, const Message& message)
{
    if (messageListener) {
        messageListener(severity, message);
    } else {
        printLine(toLine(severity, message));
    }
}

void say(MessageId id, std::initializer_list<MessagePart> words) { say(Severity::Note, Message(id, words)); }
void warn(MessageId id, std::initializer_list<MessagePart> words) { say(Severity::Warning, Message(id, words)); }

void listenToMessages(MessageListener listener) { messageListener = std::move(listener); }

Json toJson(const Message& message)
{
    Json json{{"id", toText(message.id)}};
    for (const auto& [name, part] :
         {std::pair{"file", &message.file}, {"place", &message.place}, {"value", &message.value}, {"expected", &message.expected}}) {
        if (!part->empty()) {
            json.set(name, *part);
        }
    }
    return json;
}

}  // namespace glim
