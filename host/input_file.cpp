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
        throw InputError(MessageId::Missing, {"A file name is empty; expected that of ", part::expected(expected)});
    }
    if (isUrl(file.string())) {
        throw InputError(MessageId::Unsupported, {part::file(file), ": is ", part::value("a URL"), "; expected ", part::expected(expected),
                                                  ", as glim reads files and no URLs"});
    }
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (!fs::exists(status)) {
        const std::error_code reason = error ? error : std::make_error_code(std::errc::no_such_file_or_directory);
        throw InputError(status.type() == fs::file_type::not_found ? MessageId::FileMissing : MessageId::FileUnreadable,
                         {part::file(file), ": cannot be read: ", part::value(reason.message())});
    }
    if (!fs::is_regular_file(status)) {
        throw InputError(MessageId::WrongType,
                         {part::file(file), ": is ", part::value(describe(status.type())), "; expected ", part::expected(expected)});
    }
}

}  // namespace glim
