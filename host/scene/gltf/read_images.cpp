#include "host/scene/gltf/read_images.hpp"

#include "host/error.hpp"

#include <algorithm>
#include <map>
#include <string_view>
#include <tuple>

namespace glim {
namespace {

DecodedImage makeGrey()
{
    DecodedImage grey;
    grey.width = grey.height = 1;
    grey.rgba8 = {128, 128, 128, 255};
    return grey;
}

class ImageReader {
public:
    ImageReader(const GltfFile& file, const LoadOptions& options, Scene& scene, Warnings& warnings)
        : file_(file),
          options_(options),
          scene_(scene),
          warnings_(warnings)
    {}

    void read(std::optional<Texture>& texture)
    {
        if (texture) {
            const EncodedImage& source = file_.images[texture->image];
            const EncodedImage::Range range = source.range.value_or(EncodedImage::Range());
            const auto [known, fresh] = images_.try_emplace(Source(source.uri, range.buffer, range.offset, range.length),
                                                            static_cast<std::uint32_t>(scene_.images.size()));
            if (fresh) {
                scene_.images.push_back({nameOf(texture->image), decode(texture->image)});
            }
            texture->image = known->second;
        }
    }

private:
    std::string nameOf(std::size_t image) const
    {
        const EncodedImage& source = file_.images[image];
        const bool named = source.name.empty() && !isDataUri(source.uri);
        return label("images", image, named ? source.uri : source.name);
    }

    DecodedImage decode(std::size_t image) const
    {
        const EncodedImage& source = file_.images[image];
        try {
            if (!source.range) {
                const std::vector<unsigned char> bytes = readUri(file_.path, "images[" + std::to_string(image) + "]", source.uri);
                return decodeBytes(bytes, image);
            }
            const std::vector<unsigned char>& buffer = file_.buffers[source.range->buffer];
            if (source.range->offset > buffer.size() || source.range->length > buffer.size() - source.range->offset) {
                refuse(file_, nameOf(image) + " ends past its buffer; expected a bufferView within it");
            }
            return decodeBytes(std::span(buffer).subspan(source.range->offset, source.range->length), image);
        } catch (const InputError& error) {
            if (options_.missingTextures == MissingTextures::Refuse) {
                throw;
            }
            warnings_.add(error.what() + std::string("; it is drawn grey"));
            return makeGrey();
        }
    }

    DecodedImage decodeBytes(std::span<const unsigned char> bytes, std::size_t image) const
    {
        try {
            return decodeImage(bytes);
        } catch (const InputError& error) {
            refuse(file_, nameOf(image) + " " + error.what());
        }
    }

    // Where an image's bytes are: files may name the same ones by several images.
    using Source = std::tuple<std::string_view, std::uint32_t, std::uint64_t, std::uint64_t>;

    const GltfFile& file_;
    const LoadOptions& options_;
    Scene& scene_;
    Warnings& warnings_;
    std::map<Source, std::uint32_t> images_;  // the scene's
};

}  // namespace

void readImages(const GltfFile& file, const LoadOptions& options, const std::vector<bool>& used, Scene& scene, Warnings& warnings)
{
    ImageReader reader(file, options, scene, warnings);
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        for (std::optional<Texture>* texture : texturesOf(scene.materials[i])) {
            if (used[i]) {
                reader.read(*texture);
            } else {
                texture->reset();
            }
        }
    }
}

}  // namespace glim
