#include "host/cli/check_target.hpp"

#include "host/error.hpp"
#include "host/image/whole_file.hpp"

namespace fs = std::filesystem;

namespace glim {

void checkTarget(const fs::path& target, std::string_view extension, const std::vector<fs::path>& inputs)
{
    checkWritable(target, extension);
    for (const fs::path& input : inputs) {
        std::error_code ignored;
        if (fs::equivalent(target, input, ignored)) {
            throw InputError(target.string() + ": cannot be written: it is the input " + input.string() + ".");
        }
    }
    // Permission bits do not tell all: root may write into /proc by them. This makes a file and takes it away.
    const WholeFile probe(target);
}

}  // namespace glim
