#include "host/image/radiance_map.hpp"

#include "host/error.hpp"

#include <array>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

namespace glim {
namespace {

using Pixel = std::array<std::uint8_t, 4>;  // mantissas and the exponent

struct Header {
    glm::dvec3 scale{1.0};  // pixels to radiance
    // The axis along the rows of the file and the one across them.
    bool rowsAreY = true;
    bool xBackwards = false, yUpwards = false;
    std::uint32_t rows = 0, columns = 0;
};

class HdrReader {
public:
    explicit HdrReader(const std::filesystem::path& file)
        : path_(file.string()),
          stream_(file, std::ios::binary)
    {}

    RadianceMap read();

private:
    [[noreturn]] void refuse(MessageId id, std::initializer_list<MessagePart> words) const
    {
        const Message message(id, words);
        throw InputError(Message(message, {part::file(path_), ": ", message.sentence}));
    }
    [[noreturn]] void refuseEnd(std::uint32_t row) const;
    [[noreturn]] void refuseRun(std::uint64_t count, std::size_t x, std::uint32_t row) const;
    std::string readLine();
    void readVariable(const std::string& line);
    void readResolution(const std::string& line);
    void checkLength();
    int readByte(std::uint32_t row);
    Pixel readPixel(std::uint32_t row);
    void readRow(std::uint32_t row, std::vector<Pixel>& pixels);
    void readNewRuns(std::uint32_t row, std::vector<Pixel>& pixels);
    void readOldRuns(std::uint32_t row, Pixel first, std::vector<Pixel>& pixels);

    std::string path_;
    std::ifstream stream_;
    Header header_;
};

void HdrReader::refuseEnd(std::uint32_t row) const
{
    refuse(MessageId::FileDamaged, {"ends in ", part::place("row " + std::to_string(row)), " of ", std::to_string(header_.rows)});
}

void HdrReader::refuseRun(std::uint64_t count, std::size_t x, std::uint32_t row) const
{
    refuse(MessageId::FileDamaged,
           {"has a run of ", part::value(std::to_string(count)), " pixels at ",
            part::place("pixel " + std::to_string(x) + " of row " + std::to_string(row)), ", which has ", std::to_string(header_.columns)});
}

std::string HdrReader::readLine()
{
    constexpr std::size_t kLongest = 4096;
    std::string line;
    for (int c = stream_.get(); c != '\n'; c = stream_.get()) {
        if (c < 0 || line.size() > kLongest) {
            refuse(MessageId::FileDamaged, {"has a header without an end; expected ", part::expected("a line with its resolution")});
        }
        line += static_cast<char>(c);
    }
    line.resize(line.size() - (line.ends_with('\r') ? 1 : 0));  // Windows tools end lines with both
    return line;
}

void HdrReader::readVariable(const std::string& line)
{
    const std::string name = line.substr(0, line.find('='));
    std::istringstream value(line.size() > name.size() ? line.substr(name.size() + 1) : "");
    if (name == "FORMAT") {
        if (value.str().find("32-bit_rle_rgbe") == std::string::npos) {
            refuse(MessageId::UnknownFormat,
                   {"is of the format ", part::quoted(value.str()), "; expected ", part::expected("32-bit_rle_rgbe")});
        }
    } else if (name == "EXPOSURE" || name == "COLORCORR") {
        glm::dvec3 factor(1.0);
        value >> factor.x;
        factor = glm::dvec3(factor.x);
        if (name == "COLORCORR") {
            value >> factor.y >> factor.z;
        }
        if (value.fail() || !(factor.x > 0.0 && factor.y > 0.0 && factor.z > 0.0)) {
            refuse(MessageId::OutOfRange, {"has the header line ", part::quoted(line), "; expected ", part::expected("positive numbers")});
        }
        header_.scale /= factor;
    }
}

// "-Y 512 +X 1024": the axis across the rows first.
void HdrReader::readResolution(const std::string& line)
{
    std::istringstream text(line);
    std::string first, second;
    std::int64_t rows = 0, columns = 0;
    text >> first >> rows >> second >> columns;
    const auto isAxis = [](const std::string& axis, char name) {
        return axis.size() == 2 && (axis[0] == '+' || axis[0] == '-') && axis[1] == name;
    };
    const bool byY = isAxis(first, 'Y') && isAxis(second, 'X'), byX = isAxis(first, 'X') && isAxis(second, 'Y');
    const std::int64_t width = byY ? columns : rows, height = byY ? rows : columns;
    if (text.fail() || (!byY && !byX) || width < 1 || height < 1 || width > kMaxMapWidth || height > kMaxMapHeight ||
        static_cast<std::uint64_t>(width * height) > kMaxMapTexels) {
        refuse(MessageId::OutOfRange, {"has the ", part::place("resolution"), " ", part::quoted(line), "; expected ",
                                       part::expected("one like \"-Y 512 +X 1024\", of at most 16384x8192")});
    }
    header_.rowsAreY = byY;
    header_.yUpwards = (byY ? first : second)[0] == '+';
    header_.xBackwards = (byY ? second : first)[0] == '-';
    header_.rows = static_cast<std::uint32_t>(rows);
    header_.columns = static_cast<std::uint32_t>(columns);
}

// Refuses a file that is too short for its rows, before memory is allocated. A row has a pixel, and where it is longer than a run two runs
// or more.
void HdrReader::checkLength()
{
    const std::streamoff begin = stream_.tellg(), least = header_.columns > 256 ? 12 : 4;
    const std::streamoff rows = (stream_.seekg(0, std::ios::end).tellg() - begin) / least;
    if (rows < header_.rows) {
        refuseEnd(static_cast<std::uint32_t>(rows));
    }
    stream_.seekg(begin);
}

int HdrReader::readByte(std::uint32_t row)
{
    const int byte = stream_.get();
    if (byte < 0) {
        refuseEnd(row);
    }
    return byte;
}

Pixel HdrReader::readPixel(std::uint32_t row)
{
    Pixel pixel;
    for (std::uint8_t& byte : pixel) {
        byte = static_cast<std::uint8_t>(readByte(row));
    }
    return pixel;
}

// Each channel in turn: a count above 128 repeats the next byte, another copies so many.
void HdrReader::readNewRuns(std::uint32_t row, std::vector<Pixel>& pixels)
{
    for (std::size_t c = 0; c < 4; ++c) {
        for (std::size_t x = 0; x < pixels.size();) {
            const int code = readByte(row);
            const bool repeats = code > 128;
            const auto count = static_cast<std::size_t>(repeats ? code - 128 : code);
            if (count == 0 || count > pixels.size() - x) {
                refuseRun(count, x, row);
            }
            int value = repeats ? readByte(row) : 0;
            for (std::size_t i = 0; i < count; ++i, ++x) {
                value = repeats ? value : readByte(row);
                pixels[x][c] = static_cast<std::uint8_t>(value);
            }
        }
    }
}

// Whole pixels; (1, 1, 1, n) repeats the last one n times, and further ones at once count 256-fold.
void HdrReader::readOldRuns(std::uint32_t row, Pixel first, std::vector<Pixel>& pixels)
{
    std::uint64_t weight = 1;
    Pixel pixel = first;
    for (std::size_t x = 0;; pixel = readPixel(row)) {
        const bool repeats = pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1;
        const std::uint64_t count = repeats ? pixel[3] * weight : 1;
        if (count > pixels.size() - x || (repeats && x == 0)) {
            refuseRun(count, x, row);
        }
        for (std::uint64_t i = 0; i < count; ++i, ++x) {
            pixels[x] = repeats ? pixels[x - 1] : pixel;
        }
        weight = repeats ? weight * 256 : 1;
        if (x == pixels.size()) {
            return;
        }
        if (weight > kMaxMapTexels) {
            refuse(MessageId::FileDamaged, {"has an ", part::value("endless run"), " in ", part::place("row " + std::to_string(row))});
        }
    }
}

void HdrReader::readRow(std::uint32_t row, std::vector<Pixel>& pixels)
{
    const Pixel first = readPixel(row);
    const std::size_t length = static_cast<std::size_t>(first[2]) << 8U | first[3];
    const bool isNew = pixels.size() >= 8 && pixels.size() <= 0x7fff && first[0] == 2 && first[1] == 2 && length == pixels.size();
    isNew ? readNewRuns(row, pixels) : readOldRuns(row, first, pixels);
}

RadianceMap HdrReader::read()
{
    constexpr int kMaxLines = 4096;
    int lines = 0;
    for (std::string line = readLine(); !line.empty(); line = readLine()) {
        if (++lines > kMaxLines) {
            refuse(MessageId::TooLarge, {"has more than ", part::expected(std::to_string(kMaxLines) + " lines"), " in its header"});
        }
        readVariable(line);
    }
    readResolution(readLine());
    checkLength();
    RadianceMap map;
    map.width = header_.rowsAreY ? header_.columns : header_.rows;
    map.height = header_.rowsAreY ? header_.rows : header_.columns;
    map.texels.resize(std::size_t{map.width} * map.height);
    std::vector<Pixel> pixels(header_.columns);
    for (std::uint32_t row = 0; row < header_.rows; ++row) {
        readRow(row, pixels);
        for (std::uint32_t column = 0; column < header_.columns; ++column) {
            const std::uint32_t x = header_.rowsAreY ? column : row, y = header_.rowsAreY ? row : column;
            const std::size_t at =
                std::size_t{header_.yUpwards ? map.height - 1 - y : y} * map.width + (header_.xBackwards ? map.width - 1 - x : x);
            // Without the half that Radiance's own programs add to mantissas: other renderers do not, and black stays black.
            const Pixel& p = pixels[column];
            const double unit = p[3] == 0 ? 0.0 : std::ldexp(1.0, p[3] - 136);
            map.texels[at] = glm::vec3(glm::dvec3(p[0], p[1], p[2]) * unit * header_.scale);
        }
    }
    return map;
}

}  // namespace

RadianceMap readHdr(const std::filesystem::path& file) { return HdrReader(file).read(); }

}  // namespace glim
