// Decodes the images that a scene's materials use.
#pragma once

#include "host/scene/gltf/gltf_file.hpp"
#include "host/scene/load_gltf.hpp"
#include "host/scene/warnings.hpp"

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>

namespace glim {

// What was decoded for one scene of a file, so that its next ones need not decode it again.
struct DecodedParts {
    // By the file's image, and whether it was scaled down as a colour.
    std::map<std::pair<std::uint32_t, bool>, std::shared_ptr<const DecodedImage>> images;
    std::map<std::string, std::shared_ptr<const RadianceMap>> maps;

    void forgetImage(std::size_t image)
    {
        for (const bool isColor : {false, true}) {
            images.erase({static_cast<std::uint32_t>(image), isColor});
        }
        maps.clear();  // one may be of it
    }

    // The map of that name; makes it if it is not there.
    std::shared_ptr<const RadianceMap> findMap(const std::string& name, const std::function<RadianceMap()>& make)
    {
        std::shared_ptr<const RadianceMap>& map = maps[name];
        map = map ? map : std::make_shared<RadianceMap>(make());
        return map;
    }
};

// Throws InputError that names the image and says what is wrong. Notes the image's file, if it has one, among scene.files.
DecodedImage readImage(const GltfFile& file, std::size_t image, Scene& scene, Warnings& warnings);

// Fills scene.images with those that the materials use (used[i]: material i is used) and makes the textures refer to them; unused materials
// lose their textures. Each image is there once, unless it is scaled down and used both for colours and for numbers. A missing or broken
// image is refused, or replaced by a grey one if the options say so.
void readImages(const GltfFile& file, const LoadOptions& options, const std::vector<bool>& used, DecodedParts& decoded, Scene& scene,
                Warnings& warnings);

}  // namespace glim
