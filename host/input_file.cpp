#include "host/input_file.hpp"

#include "host/error.hpp"

namespace fs = std::filesystem;

namespace glim {
namespace {

const char* describe(fs::file_type type)
{
    switch (type) {
    case fs::file_type::directory: return "a folder";
    case fs::file_type::fifo: return "a pipe";
    case fs::file_type::socket: return "a socket";
    default: return "a device";
    }
}

}  // namespace

void requireFile(const fs::path& file, const std::string& expected)
{
    if (file.empty()) {
        throw InputError("A file name is empty; expected that of " + expected);
    }
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (!fs::exists(status)) {
        throw InputError(file.string() +
                         ": cannot be read: " + (error ? error : std::make_error_code(std::errc::no_such_file_or_directory)).message());
    }
    if (!fs::is_regular_file(status)) {
        throw InputError(file.string() + ": is " + describe(status.type()) + "; expected " + expected);
    }
}

}  // namespace glim
