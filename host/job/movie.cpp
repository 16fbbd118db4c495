#include "host/job/movie.hpp"

#include "host/image/decode_image.hpp"
#include "host/image/srgb.hpp"
#include "host/job/movie_writer.hpp"
#include "host/message.hpp"
#include "host/scene/gltf/gltf_container.hpp"
#include "host/text.hpp"

#include <algorithm>
#include <ostream>

namespace glim {
namespace {

glm::uvec2 evenSize(const glm::uvec2& size) { return size + size % 2U; }

DecodedImage readPicture(const std::filesystem::path& path)
{
    try {
        return decodeImage(readBytes(path));
    } catch (const InputError& error) {
        throw InputError(error, {part::file(path), " ", error.what(), "."});
    }
}

Rgb8 overBlack(const std::uint8_t* rgba)
{
    const auto channel = [alpha = rgba[3] / 255.0](std::uint8_t value) {
        return alpha == 1.0 ? value : srgbByte(alpha * linearFromSrgb(value / 255.0));
    };
    return {channel(rgba[0]), channel(rgba[1]), channel(rgba[2])};
}

std::vector<Rgb8> evenPicture(const DecodedImage& image)
{
    const glm::uvec2 size = evenSize({image.width, image.height});
    std::vector<Rgb8> pixels;
    pixels.reserve(std::size_t{size.x} * size.y);
    for (std::uint32_t y = 0; y < size.y; ++y) {
        for (std::uint32_t x = 0; x < size.x; ++x) {
            const std::size_t row = std::min(y, image.height - 1), column = std::min(x, image.width - 1);
            pixels.push_back(overBlack(&image.rgba8[4 * (row * image.width + column)]));
        }
    }
    return pixels;
}

// False if a signal ended it.
bool writeMovie(MovieWriter& writer, const std::vector<std::filesystem::path>& pictures, const InterruptWatch& watch)
{
    for (const std::filesystem::path& path : pictures) {
        if (watch.signal() != 0) {
            return false;
        }
        writer.write(evenPicture(readPicture(path)));
    }
    return writer.finish([&] { return watch.signal() == 0; });
}

}  // namespace

double movieRate(const SequenceOptions& sequence) { return sequence.fps / (sequence.frames ? sequence.frames->step : 1); }

void checkMovie(const RenderJob& options)
{
    const glm::uvec2 size = evenSize(options.size.value_or(glm::uvec2(64)));
    MovieWriter writer(*options.movie, size, movieRate(options.sequence));
    writer.write(std::vector<Rgb8>(std::size_t{size.x} * size.y));
    writer.finish([] { return true; });
}

ExitCode makeMovie(const RenderJob& options, const std::vector<std::filesystem::path>& pictures, const InterruptWatch& watch,
                   std::ostream& reports)
{
    const std::string name = options.movie->string();
    const DecodedImage first = readPicture(pictures.front());
    if (first.hasAlpha) {
        say(MessageId::AlphaLost, {part::file(name), " is a movie, which has no alpha, so its background is black"});
    }
    MovieWriter writer(*options.movie, evenSize({first.width, first.height}), movieRate(options.sequence));
    try {
        if (writeMovie(writer, pictures, watch)) {
            writer.commit();
            const double rate = movieRate(options.sequence);
            reports << escaped(name) << ": " << pictures.size() << (pictures.size() == 1 ? " picture, " : " pictures, ")
                    << format("%.4g s at %.4g a second", static_cast<double>(pictures.size()) / rate, rate) << "\n";
            return ExitCode::Done;
        }
    } catch (const InputError&) {
        if (watch.signal() == 0) {  // of a terminal, ffmpeg has it, too
            throw;
        }
    }
    return finish(watch.signal(), "all pictures are there, but not " + name);
}

}  // namespace glim
