// Prints the words of the schema that glim checks glTF by, as a dictionary for libFuzzer: write_dictionary FILE
#include "host/scene/gltf/gltf_schema.hpp"

#include <fstream>
#include <set>
#include <string>

namespace {

// The pieces between any of `ends`.
void addWords(const std::string& text, const char* ends, std::set<std::string>& words)
{
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find_first_of(ends, at), text.size());
        if (end > at) {
            words.insert(text.substr(at, end - at));
        }
        at = end + 1;
    }
}

}  // namespace

int main(int argc, char** argv)
{
    if (argc != 2) {
        return 2;
    }
    std::set<std::string> words{"glTF",    "data:,",     "scene.gltf", "POSITION", "NORMAL",
                                "TANGENT", "TEXCOORD_0", "COLOR_0",    "JOINTS_0", "WEIGHTS_0"};
    for (const glim::SchemaRule& rule : glim::kSchemaRules) {
        addWords(rule.path, ".[]{}", words);
        if (rule.kind == glim::JsonKind::OneOf) {
            addWords(rule.target, ", ", words);
        }
    }
    for (const std::string_view path : glim::kTexturePaths) {
        addWords(std::string(path), ".", words);
    }
    for (const char* extension : glim::kMeshoptExtensions) {
        words.insert(extension);
    }
    std::ofstream file(argv[1]);
    for (const std::string& word : words) {
        file << '"' << word << "\"\n";
    }
    return file.flush() ? 0 : 1;
}
