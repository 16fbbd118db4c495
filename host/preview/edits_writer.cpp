#include "host/preview/edits_writer.hpp"

#include "host/atomic_file.hpp"
#include "host/error.hpp"
#include "host/preview/picture_writer.hpp"

namespace glim {

std::string writeEdits(const std::filesystem::path& scene, const std::vector<ShownOption>& options)
{
    const std::string ending = ".edits.json", name = freeStem(scene, {ending.c_str()}) + ending, text = toEdits(options).dump(2) + "\n";
    try {
        AtomicFile file(name);
        file.write(text.data(), text.size());
        file.commit();
    } catch (const InputError& error) {
        return error.what();
    }
    return "wrote " + name;
}

}  // namespace glim
