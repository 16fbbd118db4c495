// Sentences for the user, with words of files and of the command line in them, which may hold anything.
#pragma once

#include <functional>
#include <string>

namespace glim {

// UTF-8 that a terminal shows and does not obey: control characters and bytes that are not UTF-8 become \xNN. Escaping twice changes
// nothing.
std::string escaped(const std::string& text);

// At most 80 bytes, "..." in place of the others.
std::string shortened(const std::string& text);
std::string inQuotes(const std::string& text);  // the same in quotes

// Whether a line can be written to the file of this number within so long. Nothing waits for a reader that does not read: a terminal that
// is stopped, a pipe that is full.
bool takesMore(int file, int milliseconds = 0);

// Prints the line "glim: SENTENCE" on stderr, escaped. One of more than 8 KiB loses its middle.
// It is lost if stderr takes nothing for a second.
void say(const std::string& sentence);
// The same, about something that may make a picture other than its user expects.
void warn(const std::string& sentence);

// Where sentences go instead of stderr, from any thread.
using MessageListener = std::function<void(const std::string& sentence, bool isWarning)>;
void listenToMessages(MessageListener listener);

}  // namespace glim
