// A lock, so that only one process at a time writes a film.
#pragma once

#include "host/message.hpp"

#include <filesystem>
#include <initializer_list>

namespace glim {

// Throws InputError if another glim writes the file that `output` leads to; the sentence names that process. The lock is a hidden file
// beside it, which says whose it is, has a lock of the system (flock) and is removed at the end. A file or link of that name that is not
// glim's is refused and left as it is. Where the system has no locks, that is said and nothing is locked.
class OutputLock {
public:
    explicit OutputLock(const std::filesystem::path& output);
    ~OutputLock();
    OutputLock(const OutputLock&) = delete;
    OutputLock& operator=(const OutputLock&) = delete;

private:
    void removeLeftover() const;
    bool make();
    [[noreturn]] void refuse(MessageId id, std::initializer_list<MessagePart> why) const;

    std::filesystem::path output_, path_;
    int file_ = -1;
};

}  // namespace glim
