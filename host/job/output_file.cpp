#include "host/job/output_file.hpp"

#include "host/atomic_file.hpp"
#include "host/error.hpp"
#include "host/text.hpp"

namespace fs = std::filesystem;

namespace glim {

void checkTarget(const fs::path& target, std::string_view extension, const std::vector<fs::path>& inputs)
{
    if (!extension.empty() && lowerCase(target.extension().string()) != extension) {
        throw UsageError(MessageId::UnknownFormat, {part::file(target), ": cannot be written: its name does not end in ",
                                                    part::expected(std::string(extension)), "."});
    }
    checkWritable(target);
    std::error_code error;
    static_cast<void>(fs::status(target, error));
    if (error == std::errc::filename_too_long) {
        throw InputError(MessageId::FileUnwritable, {part::file(target), ": cannot be written: ", part::value(error.message()), "."});
    }
    for (const fs::path& input : inputs) {
        std::error_code ignored;
        if (fs::equivalent(target, input, ignored)) {
            throw InputError(MessageId::Conflict, {part::file(target), ": cannot be written: it is the input ", part::value(input), "."});
        }
    }
    // Permission bits are not enough: they let root write into /proc. This makes a file and removes it.
    const AtomicFile probe(target);
}

void writeText(const fs::path& path, std::string_view text)
{
    AtomicFile file(path);
    file.write(text.data(), text.size());
    file.commit();
}

void writeJson(const fs::path& path, const Json& json) { writeText(path, json.dump(2) + "\n"); }

}  // namespace glim
