// The options of pictures to look at (PNG, JPEG, WebP): their files, exposure and tone mapping.
#pragma once

#include "host/job/option_table.hpp"
#include "host/render/film_pictures.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace glim {

using PictureFiles = std::vector<std::filesystem::path>;

// --exposure of `picture`, as in "the PNG", and --tone, with its default in the help.
void addLook(OptionTable& table, LookOptions& look, const std::string& picture, const std::string& tone);

// --image; --png is its former name.
void addPictureFiles(OptionTable& table, PictureFiles& files);
// An `output` whose name is a picture's becomes one of the files, and the film is not kept. Refuses names of an unknown kind.
void resolveOutput(std::optional<std::filesystem::path>& output, PictureFiles& files);
// Refuses a look without a file, and files of an unknown kind.
void resolvePictureFiles(const OptionTable& table, const PictureFiles& files);
// As checkTarget (output_file.hpp), of each file.
void checkPictureTargets(const PictureFiles& files, const std::vector<std::filesystem::path>& inputs);

// The look of a film. Says which exposure was chosen.
Look chooseLook(const LookOptions& options, const Film& film);

void writePictures(const PictureFiles& files, const Film& film, const Look& look);

}  // namespace glim
