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

bool isUrl(const std::string& name) { return name.find("://") != std::string::npos; }

void requireFile(const fs::path& file, const std::string& expected)
{
    if (file.empty()) {
        throw InputError("A file name is empty; expected that of " + expected);
    }
    if (isUrl(file.string())) {
        throw InputError(file.string() + ": is a URL; expected " + expected + ", as glim reads files and no URLs");
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
