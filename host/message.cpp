#include "host/message.hpp"

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

void tell(const std::string& sentence, bool isWarning)
{
    constexpr int kPatience = 1000;  // milliseconds
    constexpr std::size_t kMax = 8192, kBegin = 6144, kEnd = 1024;
    const bool fits = sentence.size() <= kMax;
    const std::string bounded = fits ? sentence : sentence.substr(0, kBegin) + " ... " + sentence.substr(sentence.size() - kEnd);
    if (messageListener) {
        messageListener(escaped(bounded), isWarning);
    } else if (takesMore(STDERR_FILENO, kPatience)) {
        std::cerr << "glim: " + escaped(bounded) + '\n';
    }
}

}  // namespace

bool takesMore(int file, int milliseconds)
{
    pollfd poll{file, POLLOUT, 0};
    return ::poll(&poll, 1, milliseconds) > 0 && (poll.revents & POLLOUT) != 0;
}

void say(const std::string& sentence) { tell(sentence, false); }
void warn(const std::string& sentence) { tell(sentence, true); }

void listenToMessages(MessageListener listener) { messageListener = std::move(listener); }

}  // namespace glim
