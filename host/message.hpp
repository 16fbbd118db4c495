// Sentences for the user, with words of files and of the command line in them, which may hold anything.
#pragma once

#include "host/message_id.hpp"

#include <functional>
#include <initializer_list>
#include <string>
#include <utility>

namespace glim {

class Json;

// UTF-8 that a terminal shows and does not obey: control characters and bytes that are not UTF-8 become \xNN. Escaping twice changes
// nothing.
std::string escaped(const std::string& text);

// At most 80 bytes, "..." in place of the others.
std::string shortened(const std::string& text);
std::string inQuotes(const std::string& text);  // the same in quotes

// Whether a line can be written to the file of this number within so long. Nothing waits for a reader that does not read: a terminal that
// is stopped, a pipe that is full.
bool takesMore(int file, int milliseconds = 0);

// Words of a sentence and, if they name one of its parts, that part.
struct MessagePart {
    enum class Kind { Words, File, Place, Value, Expected };

    MessagePart(const char* text)
        : words(text)
    {}
    MessagePart(std::string text)
        : words(std::move(text))
    {}
    MessagePart(Kind which, std::string text, std::string alone)
        : kind(which),
          words(std::move(text)),
          part(std::move(alone))
    {}

    Kind kind = Kind::Words;
    std::string words, part;
};

// The parts of a sentence. These are of its words; `quoted` writes a value in quotes and shortens it.
namespace part {
MessagePart file(const std::string& path);
MessagePart place(const std::string& place);  // in the file, as in "nodes[3].rotation"; an option
MessagePart value(const std::string& value);
MessagePart quoted(const std::string& value);
MessagePart expected(const std::string& what);
}  // namespace part

// One sentence for the user, escaped, and for programs what it is about. A part is empty if the sentence has none. Of a sentence or a part
// of more than 8 KiB the middle is lost.
struct Message {
    // The first words of each part are that part.
    Message(MessageId which, std::initializer_list<MessagePart> words);
    // `words` around the sentence of `inner`: the id, and each part that `words` lack, are those of `inner`.
    Message(const Message& inner, std::initializer_list<MessagePart> words);

    bool operator==(const Message&) const = default;

    MessageId id;
    std::string sentence;
    std::string file, place, value, expected;
};

enum class Severity { Note, Warning, Error };

// How messages are printed: "glim: SENTENCE", or for programs as JSON, {"severity": "error", "id": "file-missing", "file": "a.gltf",
// "sentence": "..."}.
enum class MessageForm { Text, Json };
void setMessageForm(MessageForm form);
std::string toLine(Severity severity, const Message& message);

// Prints the line on stderr. It is lost if stderr takes nothing for a second.
void say(Severity severity, const Message& message);
void say(MessageId id, std::initializer_list<MessagePart> words);   // a note
void warn(MessageId id, std::initializer_list<MessagePart> words);  // of what may make a picture other than its user expects

// Where messages go instead of stderr, from any thread.
using MessageListener = std::function<void(Severity severity, const Message& message)>;
void listenToMessages(MessageListener listener);

// {"id": "file-missing", "file": "a.gltf"}: the id, and the parts that the message has.
Json toJson(const Message& message);

}  // namespace glim
