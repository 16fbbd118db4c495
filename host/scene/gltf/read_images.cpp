#include "host/scene/gltf/read_images.hpp"

#include "host/error.hpp"
#include "host/image/shrink_image.hpp"

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

std::string getImageName(const GltfFile& file, std::size_t image)
{
    const EncodedImage& source = file.images[image];
    const bool named = source.name.empty() && !isDataUri(source.uri);
    return label("images", image, named ? source.uri : source.name);
}

DecodedImage decodeNamed(const GltfFile& file, std::size_t image, std::span<const unsigned char> bytes, Warnings& warnings)
{
    try {
        DecodedImage decoded = decodeImage(bytes);
        if (decoded.noEnd) {
            warnings.add(MessageId::UnterminatedJpeg, "JPEG images without their end marker are drawn", getImageName(file, image));
        }
        return decoded;
    } catch (const InputError& error) {
        throw InputError(error, {part::file(file.path), ": ", part::place(getImageName(file, image)), " ", error.what()});
    }
}

void noteFile(const GltfFile& file, std::size_t image, Scene& scene)
{
    const EncodedImage& source = file.images[image];
    if (!source.range && !isDataUri(source.uri)) {
        scene.files.push_back(externalFile(file.path, source.uri));
    }
}

class ImageReader {
public:
    ImageReader(const GltfFile& file, const LoadOptions& options, DecodedParts& decoded, Scene& scene, Warnings& warnings)
        : file_(file),
          options_(options),
          decoded_(decoded),
          scene_(scene),
          warnings_(warnings)
    {}

    void read(Texture& texture, bool isColor)
    {
        const auto known = images_.find({sourceOf(texture.image), isColor});
        texture.image = known == images_.end() ? add(texture.image, isColor) : known->second;
    }

private:
    // Where an image's bytes are: files may name the same ones by several images.
    using Source = std::tuple<std::string_view, std::size_t, std::uint64_t, std::uint64_t>;

    Source sourceOf(std::uint32_t image) const
    {
        const EncodedImage& source = file_.images[image];
        const BufferRange range = source.range.value_or(BufferRange());
        return {source.uri, range.buffer, range.offset, range.length};
    }

    std::uint32_t add(std::uint32_t image, bool isColor)
    {
        const std::shared_ptr<const DecodedImage> pixels = find(image, isColor);
        bytes_ += pixels->rgba8.size() + 2 * pixels->rgba16.size();
        if (bytes_ > kMaxTextureBytes) {
            refuse(file_, MessageId::TooLarge,
                   {"its textures take more than ", part::value(std::to_string(kMaxTextureBytes >> 20U)), " MiB; expected ",
                    part::expected("less (--max-texture N scales them down)")});
        }
        const auto index = static_cast<std::uint32_t>(scene_.images.size());
        scene_.images.emplace_back(getImageName(file_, image), pixels);
        images_[{sourceOf(image), isColor}] = index;
        if (decoded_.images[{image, !isColor}] == pixels) {
            images_[{sourceOf(image), !isColor}] = index;
        }
        return index;
    }

    std::shared_ptr<const DecodedImage> find(std::uint32_t image, bool isColor)
    {
        std::shared_ptr<const DecodedImage>& pixels = decoded_.images[{image, isColor}];
        if (pixels) {
            noteFile(file_, image, scene_);
            return pixels;
        }
        DecodedImage original = decode(image);
        const bool fits = std::max(original.width, original.height) <= options_.maxTexture;
        pixels = std::make_shared<DecodedImage>(shrinkImage(std::move(original), options_.maxTexture, isColor));
        if (fits) {
            decoded_.images[{image, !isColor}] = pixels;
        }
        return pixels;
    }

    DecodedImage decode(std::uint32_t image) const
    {
        try {
            return readImage(file_, image, scene_, warnings_);
        } catch (const InputError& error) {
            if (options_.missingTextures == MissingTextures::Refuse) {
                throw InputError(error, {error.what(), " (--missing-textures grey draws it grey)"});
            }
            std::string reason = error.what();
            reason.erase(0, reason.rfind(file_.path + ": ", 0) == 0 ? file_.path.size() + 2 : 0);
            warnings_.add({MessageId::GreyImage, {"images that cannot be read are drawn grey"}},
                          MessagePart(MessagePart::Kind::Place, reason, error.message().place));
            return makeGrey();
        }
    }

    const GltfFile& file_;
    const LoadOptions& options_;
    DecodedParts& decoded_;
    Scene& scene_;
    Warnings& warnings_;
    std::map<std::pair<Source, bool>, std::uint32_t> images_;  // the scene's, by the bytes and whether they are colours
    std::uint64_t bytes_ = 0;
};

}  // namespace

DecodedImage readImage(const GltfFile& file, std::size_t image, Scene& scene, Warnings& warnings)
{
    const EncodedImage& source = file.images[image];
    if (!source.range) {
        // A file of another kind may have gigabytes, and so may what follows a picture.
        constexpr std::uint64_t kBeginning = 16, kMax = std::uint64_t{1} << 30U;
        const std::string place = "images[" + std::to_string(image) + "]";
        std::vector<unsigned char> bytes = readUri(file.path, place, source.uri, kBeginning);
        if (!isDataUri(source.uri) && beginsAsImage(bytes)) {
            bytes = readUri(file.path, place, source.uri, kMax);
        }
        noteFile(file, image, scene);
        return decodeNamed(file, image, bytes, warnings);
    }
    return decodeNamed(file, image, findBytes(file.path, file.buffers, *source.range, getImageName(file, image)), warnings);
}

void readImages(const GltfFile& file, const LoadOptions& options, const std::vector<bool>& used, DecodedParts& decoded, Scene& scene,
                Warnings& warnings)
{
    ImageReader reader(file, options, decoded, scene, warnings);
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        for (const TextureSlot& slot : kTextureSlots) {
            std::optional<Texture>& texture = scene.materials[i].textures[slot.number];
            if (!used[i]) {
                texture.reset();
            } else if (texture) {
                reader.read(*texture, slot.holds == TexelKind::Color);
            }
        }
    }
}

}  // namespace glim
