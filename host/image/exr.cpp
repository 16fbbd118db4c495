#include "host/image/exr.hpp"

#include "host/atomic_file.hpp"
#include "host/error.hpp"
#include "host/image/exr_header.hpp"
#include "host/input_file.hpp"
#include "host/memory.hpp"
#include "host/message.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfOpaqueAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <OpenEXR/ImfVersion.h>

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <functional>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

namespace fs = std::filesystem;

namespace glim {
namespace {

// A damaged header may claim any size. A file with more pixels is refused before memory is allocated.
constexpr std::uint64_t kMaxPixels = std::uint64_t{1} << 30;

// Deflate makes 1032 bytes of one at most, and PXR24 four of three.
constexpr std::uint64_t kMaxInflation = 1400;

constexpr std::size_t kDigits = 64;  // of a SHA-256

constexpr const char* kOpaqueType = "glim";  // of OpaqueBytes

std::size_t pixelCount(const Image& image) { return std::size_t{image.width} * image.height; }

void checkIsExr(const fs::path& path)
{
    requireFile(path, "an OpenEXR file");
    std::ifstream stream(path, std::ios::binary);
    if (!stream) {
        throw InputError(MessageId::FileUnreadable, {part::file(path), ": cannot be opened: ", part::value(std::strerror(errno)), "."});
    }
    char magic[4] = {};
    stream.read(magic, sizeof magic);
    if (!stream || !Imf::isImfMagic(magic)) {
        throw InputError(MessageId::UnknownFormat, {part::file(path), ": is not ", part::expected("an OpenEXR file"), "."});
    }
    checkExrHeader(path);
}

// Most of the time of a file is compression. Returns the number of threads.
int useAllCores()
{
    static const int threads = [] {
        Imf::setGlobalThreadCount(static_cast<int>(std::thread::hardware_concurrency()));
        return Imf::globalThreadCount();
    }();
    return threads;
}

// Runs `step` and turns OpenEXR's exceptions into InputError.
void guarded(const fs::path& path, MessageId id, const std::function<void()>& step)
{
    try {
        step();
    } catch (const InputError&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw InputError(MessageId::OutOfMemory, {part::file(path), ": ", memorySentence(), "."});
    } catch (const std::exception& error) {
        const char* const failure = id == MessageId::FileUnwritable ? "cannot be written" : "is damaged, or not an OpenEXR picture";
        throw InputError(id, {part::file(path), ": ", failure, " (", part::value(error.what()), ")."});
    }
}

// Whether the attribute describes the file's storage rather than its picture.
bool isOpenExrsOwn(const std::string& name)
{
    static const Imf::Header fresh;
    return fresh.find(name) != fresh.end() || name == "type" || name == "name" || name == "version" || name == "chunkCount";
}

void readAttributes(const Imf::Header& header, Image& image)
{
    for (auto entry = header.begin(); entry != header.end(); ++entry) {
        if (isOpenExrsOwn(entry.name())) {
            continue;
        }
        const Imf::Attribute& attribute = entry.attribute();
        auto keep = [&](auto value) { image.attributes[entry.name()] = std::move(value); };
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute)) {
            keep(text->value());
        } else if (const auto* precise = dynamic_cast<const Imf::DoubleAttribute*>(&attribute)) {
            keep(precise->value());
        } else if (const auto* real = dynamic_cast<const Imf::FloatAttribute*>(&attribute)) {
            keep(static_cast<double>(real->value()));
        } else if (const auto* whole = dynamic_cast<const Imf::IntAttribute*>(&attribute)) {
            keep(static_cast<double>(whole->value()));
        } else if (const auto* opaque = dynamic_cast<const Imf::OpaqueAttribute*>(&attribute);
                   opaque != nullptr && std::string_view(opaque->typeName()) == kOpaqueType) {
            const auto* bytes = reinterpret_cast<const std::byte*>(static_cast<const char*>(opaque->data()));
            keep(OpaqueBytes(bytes, bytes + opaque->dataSize()));
        }
    }
}

void readHeader(const fs::path& path, const Imf::Header& header, Image& image)
{
    const Imath::Box2i window = header.dataWindow();
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
    const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
    if (width < 1 || height < 1 || static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) > kMaxPixels) {
        throw InputError(MessageId::TooLarge, {part::file(path), ": its ", part::place("data window"), " is ",
                                               part::value(std::to_string(width) + "x" + std::to_string(height)), ", expected ",
                                               part::expected("1 to " + std::to_string(kMaxPixels) + " pixels"), "."});
    }
    image.width = static_cast<std::uint32_t>(width);
    image.height = static_cast<std::uint32_t>(height);
    const auto gap = [](std::int64_t from, std::int64_t to) { return static_cast<std::uint32_t>(std::max(to - from, std::int64_t{0})); };
    image.rowsAbove = gap(header.displayWindow().min.y, window.min.y);
    image.columnsLeft = gap(header.displayWindow().min.x, window.min.x);
    image.columnsRight = gap(window.max.x, header.displayWindow().max.x);
    image.rowsBelow = gap(window.max.y, header.displayWindow().max.y);
    readAttributes(header, image);
}

// OpenEXR addresses pixels by their position in the data window, relative to a base that may lie outside of `plane`.
template <class Value>
Imf::Slice sliceOf(Imf::PixelType type, const std::vector<Value>& plane, const Imath::Box2i& window)
{
    return Imf::Slice::Make(type, plane.data(), window.min, window.max.x - window.min.x + 1, window.max.y - window.min.y + 1,
                            sizeof(Value));
}

// Refuses more pixels than the bytes of the file can be decompressed to.
void checkInflation(const fs::path& path, const Imf::Header& header, const Image& image)
{
    constexpr std::uint64_t kSmall = std::uint64_t{1} << 24;
    const Imf::Compression method = header.compression();
    if (method != Imf::NO_COMPRESSION && method != Imf::RLE_COMPRESSION && method != Imf::ZIPS_COMPRESSION &&
        method != Imf::ZIP_COMPRESSION && method != Imf::PXR24_COMPRESSION) {
        return;
    }
    std::uint64_t bytes = 0;
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
        bytes += pixelCount(image) * (channel.channel().type == Imf::HALF ? 2 : 4);
    }
    if (const std::uint64_t size = fs::file_size(path); bytes > kSmall + kMaxInflation * size) {
        throw InputError(MessageId::FileDamaged, {part::file(path), ": its ", part::place("data window"), " of ",
                                                  part::value(std::to_string(image.width) + "x" + std::to_string(image.height)),
                                                  " pixels has ", std::to_string(bytes >> 20U), " MiB, expected ",
                                                  part::expected("what its " + std::to_string(size) + " bytes can hold"), "."});
    }
}

// Decompresses one row, which most damage to the header makes impossible, before memory is allocated for all.
void tryFirstRow(Imf::InputFile& file)
{
    const Imath::Box2i window = file.header().dataWindow();
    std::vector<float> row(static_cast<std::size_t>(std::int64_t{window.max.x} - window.min.x + 1));
    Imf::FrameBuffer frame;
    for (auto channel = file.header().channels().begin(); channel != file.header().channels().end(); ++channel) {
        const Imf::PixelType type = channel.channel().type == Imf::UINT ? Imf::UINT : Imf::FLOAT;
        frame.insert(channel.name(), sliceOf(type, row, {window.min, {window.max.x, window.min.y}}));
    }
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y);
}

void readChannels(const fs::path& path, Imf::InputFile& file, Image& image)
{
    const Imf::Header& header = file.header();
    const Imath::Box2i window = header.dataWindow();
    checkInflation(path, header, image);
    Imf::FrameBuffer frame;
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
        if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1) {
            throw InputError(MessageId::Unsupported, {part::file(path), ": its channel ", part::place(channel.name()),
                                                      " is subsampled, expected ", part::expected("a value for every pixel"), "."});
        }
    }
    tryFirstRow(file);
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
        if (channel.channel().type == Imf::UINT) {
            auto& plane = image.counts[channel.name()];
            plane.resize(pixelCount(image));
            frame.insert(channel.name(), sliceOf(Imf::UINT, plane, window));
        } else {
            auto& plane = image.channels[channel.name()];
            plane.resize(pixelCount(image));
            frame.insert(channel.name(), sliceOf(Imf::FLOAT, plane, window));
        }
    }
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
}

class ExrStream : public Imf::OStream {
public:
    ExrStream(AtomicFile& file, const std::string& name)
        : OStream(name.c_str()),
          file_(file)
    {}
    void write(const char bytes[], int count) override
    {
        file_.write(bytes, static_cast<std::size_t>(count));
        if (isHeader_) {
            header_.append(bytes, static_cast<std::size_t>(count));
        }
    }
    std::uint64_t tellp() override { return file_.tell(); }
    void seekp(std::uint64_t position) override { file_.seek(position); }
    // All that was written so far. To be called once.
    std::string endHeader()
    {
        isHeader_ = false;
        return std::move(header_);
    }

private:
    AtomicFile& file_;
    std::string header_;
    bool isHeader_ = true;
};

// OpenEXR reads it as its base.
class WrittenBytes : public Imf::OpaqueAttribute {
public:
    explicit WrittenBytes(OpaqueBytes bytes)
        : OpaqueAttribute(kOpaqueType),
          bytes_(std::move(bytes))
    {}
    Imf::Attribute* copy() const override { return new WrittenBytes(*this); }
    void writeValueTo(Imf::OStream& stream, int /*version*/) const override
    {
        stream.write(reinterpret_cast<const char*>(bytes_.data()), static_cast<int>(bytes_.size()));
    }

private:
    OpaqueBytes bytes_;
};

Imf::Header headerOf(const Image& image)
{
    const auto left = static_cast<int>(image.columnsLeft), top = static_cast<int>(image.rowsAbove);
    const int right = left + static_cast<int>(image.width) - 1, bottom = top + static_cast<int>(image.height) - 1;
    Imf::Header header({{0, 0}, {right + static_cast<int>(image.columnsRight), bottom + static_cast<int>(image.rowsBelow)}},
                       {{left, top}, {right, bottom}});
    constexpr Imf::Compression kCompressions[] = {Imf::ZIP_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::RLE_COMPRESSION,
                                                  Imf::NO_COMPRESSION};
    header.compression() = kCompressions[static_cast<std::size_t>(image.compression)];
    header.zipCompressionLevel() = 2;                       // of a film, level 4 takes a fifth more time and 1 % less space
    Imf::addChromaticities(header, Imf::Chromaticities());  // the default is Rec.709 with the white D65
    for (const auto& [name, value] : image.attributes) {
        if (const auto* number = std::get_if<double>(&value)) {
            header.insert(name, Imf::DoubleAttribute(*number));
        } else if (const auto* matrix = std::get_if<glm::mat4>(&value)) {
            Imath::M44f rows;
            std::memcpy(rows.x, glm::value_ptr(glm::transpose(*matrix)), sizeof rows.x);
            header.insert(name, Imf::M44fAttribute(rows));
        } else if (const auto* bytes = std::get_if<OpaqueBytes>(&value)) {
            header.insert(name, WrittenBytes(*bytes));
        } else {
            header.insert(name, Imf::StringAttribute(name == kHeaderDigest ? std::string(kDigits, '0') : std::get<std::string>(value)));
        }
    }
    for (const auto& [name, plane] : image.channels) {
        header.channels().insert(name, Imf::Channel(image.halves.contains(name) ? Imf::HALF : Imf::FLOAT));
    }
    for (const auto& [name, plane] : image.counts) {
        header.channels().insert(name, Imf::Channel(Imf::UINT));
    }
    return header;
}

using Halves = std::map<std::string, std::vector<Imath::half>>;

Halves roundToHalves(const Image& rows, const std::set<std::string>& names)
{
    Halves halves;
    for (const std::string& name : names) {
        const std::vector<float>& values = rows.channels.at(name);
        halves[name].assign(values.begin(), values.end());
    }
    return halves;
}

// The slices of `rows`, whose first pixel is at `corner` of the display window; of channels in `halves` those there.
Imf::FrameBuffer frameOf(const Image& rows, const Halves& halves, const Imath::V2i& corner)
{
    const Imath::Box2i window(corner, corner + Imath::V2i(static_cast<int>(rows.width) - 1, static_cast<int>(rows.height) - 1));
    Imf::FrameBuffer frame;
    for (const auto& [name, plane] : rows.channels) {
        const auto half = halves.find(name);
        frame.insert(name, half == halves.end() ? sliceOf(Imf::FLOAT, plane, window) : sliceOf(Imf::HALF, half->second, window));
    }
    for (const auto& [name, plane] : rows.counts) {
        frame.insert(name, sliceOf(Imf::UINT, plane, window));
    }
    return frame;
}

}  // namespace

Image readExr(const fs::path& path)
{
    checkIsExr(path);
    Image image;
    guarded(path, MessageId::FileDamaged, [&] {
        Imf::InputFile file(path.c_str(), useAllCores());
        if (!file.isComplete()) {
            throw InputError(MessageId::FileDamaged,
                             {part::file(path), ": is ", part::value("incomplete"), ": rows of pixels are missing."});
        }
        if (Imf::isMultiPart(file.version())) {
            warn(MessageId::PartsIgnored, {part::file(path), ": has several parts, and only the first is read"});
        }
        readHeader(path, file.header(), image);
        readChannels(path, file, image);
    });
    return image;
}

Image readExrHeader(const fs::path& path)
{
    checkIsExr(path);
    Image image;
    guarded(path, MessageId::FileDamaged, [&] {
        const Imf::InputFile file(path.c_str());
        readHeader(path, file.header(), image);
    });
    return image;
}

void checkHeaderDigest(const fs::path& path, bool isSealed)
{
    std::ifstream stream(path, std::ios::binary);
    const auto seal = findSeal(stream, kHeaderDigest);
    if (!seal && isSealed) {
        throw InputError(MessageId::FileDamaged, {part::file(path), ": is damaged: it has no attribute ", part::place(kHeaderDigest), "."});
    }
    if (seal && seal->text != seal->digest) {
        throw InputError(MessageId::FileDamaged,
                         {part::file(path), ": is damaged: the SHA-256 of its ", part::place("header"), " is ", part::value(seal->digest),
                          ", expected ", MessagePart(MessagePart::Kind::Expected, inQuotes(seal->text), seal->text), "."});
    }
}

struct ExrWriter::Output {
    Output(const fs::path& target, const Image& picture)
        : path(target),
          atomic(target),
          stream(atomic, target.string()),
          corner(static_cast<int>(picture.columnsLeft), static_cast<int>(picture.rowsAbove)),
          halves(picture.halves)
    {
        guarded(path, MessageId::FileUnwritable, [&] { file.emplace(stream, headerOf(picture), useAllCores()); });
        std::istringstream header(stream.endHeader());
        seal = findSeal(header, kHeaderDigest);
    }

    fs::path path;
    AtomicFile atomic;
    ExrStream stream;
    std::optional<Imf::OutputFile> file;
    Imath::V2i corner;  // of the next row
    std::set<std::string> halves;
    std::optional<HeaderSeal> seal;
};

ExrWriter::ExrWriter(const fs::path& path, const Image& picture)
    : output_(std::make_unique<Output>(path, picture))
{}

ExrWriter::~ExrWriter() = default;

void ExrWriter::write(const Image& rows)
{
    guarded(output_->path, MessageId::FileUnwritable, [&] {
        const Halves halves = roundToHalves(rows, output_->halves);
        output_->file->setFrameBuffer(frameOf(rows, halves, output_->corner));
        output_->file->writePixels(static_cast<int>(rows.height));
    });
    output_->corner.y += static_cast<int>(rows.height);
}

void ExrWriter::commit()
{
    guarded(output_->path, MessageId::FileUnwritable, [&] { output_->file.reset(); });  // which writes the table of rows
    if (const auto& seal = output_->seal) {
        output_->atomic.seek(seal->position);
        output_->atomic.write(seal->digest.data(), seal->digest.size());
    }
    output_->atomic.commit();
}

void writeExr(const fs::path& path, const Image& image)
{
    ExrWriter writer(path, image);
    writer.write(image);
    writer.commit();
}

}  // namespace glim
