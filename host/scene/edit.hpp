// A change to a scene's file: a new value at a pointer of its object model.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace glim {

struct Edit {
    std::string pointer;  // as of KHR_animation_pointer: /materials/0/alphaCutoff; a name may stand for an index
    std::string value;    // JSON

    bool operator==(const Edit&) const = default;
};

// What edits can change in a glTF file, of which only the JSON is read.
class EditableFile {
public:
    // Throws InputError.
    explicit EditableFile(const std::filesystem::path& file);

    // The names of the elements of a list, as of /materials; empty ones of those without a name.
    std::vector<std::string> namesAt(const std::string& list) const;
    // Which image is drawn by a texture of the file.
    std::optional<std::size_t> imageOf(std::size_t texture) const;
    // The element at a pointer after these edits, as JSON. Of a node with a matrix that can be split it has the parts as well. Throws
    // InputError if an edit is refused.
    std::string valueAt(const std::string& pointer, const std::vector<Edit>& edits) const;

private:
    struct Contents;

    std::shared_ptr<const Contents> contents_;
};

}  // namespace glim
