#include "host/image/radiance_map.hpp"

#include "host/error.hpp"
#include "host/image/exr_header.hpp"
#include "host/input_file.hpp"

#include <OpenEXR/ImfArray.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfVersion.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace glim {
namespace {

void checkMapSize(const std::string& path, std::int64_t width, std::int64_t height)
{
    if (width < 1 || height < 1 || width > kMaxMapWidth || height > kMaxMapHeight ||
        static_cast<std::uint64_t>(width * height) > kMaxMapTexels) {
        throw InputError(MessageId::TooLarge,
                         {part::file(path), ": is a map of ", part::value(std::to_string(width) + "x" + std::to_string(height)),
                          " texels; expected ", part::expected("at most 16384x8192")});
    }
}

// Where a file holds its picture.
struct Place {
    int part = 0;
    std::array<std::string, 3> channels;  // red, green and blue, or one name three times
    int rank = 5;                         // the lower, the surer
};

// By the names of its channels: R, G and B, those of Blender's combined layer ("ViewLayer.Combined.R"), or Y alone. Of several parts each
// may be a layer.
Place findIn(const Imf::Header& header, int part, bool alone)
{
    const Imf::ChannelList& channels = header.channels();
    const auto has = [&](const std::string& name) { return channels.findChannel(name) != nullptr; };
    std::vector<std::pair<std::string, int>> layers{{"", alone || (header.hasName() && header.name().ends_with("Combined")) ? 0 : 2}};
    for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
        if (const std::string name = channel.name(); name.ends_with(".Combined.R")) {
            layers.emplace_back(name.substr(0, name.size() - 1), 1);
        }
    }
    Place place;
    for (const auto& [layer, rank] : layers) {
        if (rank < place.rank && has(layer + "R") && has(layer + "G") && has(layer + "B")) {
            place = {part, {layer + "R", layer + "G", layer + "B"}, rank};
        }
    }
    const bool grey = has("Y") && !has("RY") && !has("BY");
    return place.rank == Place().rank && grey ? Place{part, {"Y", "Y", "Y"}, 3} : place;
}

Place findPicture(const std::string& path, const Imf::MultiPartInputFile& file)
{
    Place best;
    for (int part = 0; part < file.parts(); ++part) {
        const Imf::Header& header = file.header(part);
        if (header.hasType() && Imf::isDeepData(header.type())) {
            continue;
        }
        if (const Place place = findIn(header, part, file.parts() == 1); place.rank < best.rank) {
            best = place;
        }
    }
    if (best.rank == Place().rank) {
        throw InputError(MessageId::Missing,
                         {part::file(path), ": has no ",
                          part::expected("channels R, G and B, nor a layer Combined with these, nor Y alone"), "; expected one of these"});
    }
    return best;
}

RadianceMap readExrMap(const std::string& path)
{
    checkExrHeader(path);
    Imf::MultiPartInputFile parts(path.c_str());
    const Place place = findPicture(path, parts);
    Imf::InputPart file(parts, place.part);
    const std::array<std::string, 3>& names = place.channels;
    const Imath::Box2i display = file.header().displayWindow(), data = file.header().dataWindow();
    const std::int64_t width = std::int64_t{display.max.x} - display.min.x + 1, height = std::int64_t{display.max.y} - display.min.y + 1;
    checkMapSize(path, width, height);
    const std::int64_t across = std::int64_t{data.max.x} - data.min.x + 1;
    checkMapSize(path, across, std::int64_t{data.max.y} - data.min.y + 1);
    RadianceMap map;
    map.width = static_cast<std::uint32_t>(width);
    map.height = static_cast<std::uint32_t>(height);
    map.texels.resize(static_cast<std::size_t>(width * height), glm::vec3(0.0F));
    // A row of the data window at a time; what the display window shows of it goes into the map.
    std::vector<glm::vec3> row(static_cast<std::size_t>(across));
    const int channels = names[0] == "Y" ? 1 : 3;
    for (int y = data.min.y; y <= data.max.y; ++y) {
        Imf::FrameBuffer buffer;
        for (int c = 0; c < channels; ++c) {
            char* const base =
                reinterpret_cast<char*>(&row[0][c]) - std::int64_t{data.min.x} * static_cast<std::int64_t>(sizeof(glm::vec3));
            buffer.insert(names[static_cast<std::size_t>(c)], Imf::Slice(Imf::FLOAT, base, sizeof(glm::vec3), 0));
        }
        file.setFrameBuffer(buffer);
        file.readPixels(y);
        if (y < display.min.y || y > display.max.y) {
            continue;
        }
        for (int x = std::max(data.min.x, display.min.x); x <= std::min(data.max.x, display.max.x); ++x) {
            glm::vec3& texel = map.texels[static_cast<std::size_t>((y - display.min.y) * width + (x - display.min.x))];
            texel = row[static_cast<std::size_t>(x - data.min.x)];
            texel = channels == 1 ? glm::vec3(texel.x) : texel;
        }
    }
    return map;
}

void repair(RadianceMap& map)
{
    for (glm::vec3& texel : map.texels) {
        bool broken = false;
        for (int c = 0; c < 3; ++c) {
            if (!std::isfinite(texel[c]) || texel[c] < 0.0F) {
                texel[c] = 0.0F;
                broken = true;
            }
        }
        map.repaired += broken ? 1 : 0;
    }
}

std::string readStart(const std::filesystem::path& file)
{
    requireFile(file, "a .hdr or .exr map");
    std::ifstream stream(file, std::ios::binary);
    if (!stream) {
        throw InputError(MessageId::FileUnreadable, {part::file(file), ": cannot be opened: ", part::value(std::strerror(errno))});
    }
    char start[4] = {};
    stream.read(start, sizeof start);
    return {start, static_cast<std::size_t>(stream.gcount())};
}

}  // namespace

RadianceMap readRadianceMap(const std::filesystem::path& file)
{
    const std::string start = readStart(file), path = file.string();
    RadianceMap map;
    if (start.size() == 4 && Imf::isImfMagic(start.data())) {
        try {
            map = readExrMap(path);
        } catch (const InputError&) {
            throw;
        } catch (const std::exception& error) {
            throw InputError(MessageId::FileDamaged, {part::file(path), ": cannot be read as OpenEXR (", part::value(error.what()), ")"});
        }
    } else if (start.rfind("#?", 0) == 0) {
        map = readHdr(file);
        checkMapSize(path, map.width, map.height);
    } else {
        throw InputError(MessageId::UnknownFormat,
                         {part::file(path), ": is neither ", part::expected("OpenEXR nor Radiance (.hdr)"), "; expected one of these"});
    }
    repair(map);
    return map;
}

}  // namespace glim
