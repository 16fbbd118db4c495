#include "host/scene/gltf/read_accessor.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

namespace glim {
namespace {

static_assert(TINYGLTF_TYPE_VEC2 == 2 && TINYGLTF_TYPE_VEC3 == 3 && TINYGLTF_TYPE_VEC4 == 4);
static_assert(std::endian::native == std::endian::little, "glTF buffers are little-endian and are read as they are");

// An accessor without bufferView is all zeros, so a short file could claim any amount of memory.
constexpr std::size_t kMaxUnbackedElements = std::size_t{1} << 22U;

// Any number of primitives may use the same elements. So many are never too many; beyond, a file has at most as many as 64 bytes for each
// of its own hold in components of 4 bytes. Khronos' duck in Draco has 1.9.
constexpr std::uint64_t kFewUnbacked = std::uint64_t{1} << 23U, kUnbackedPerByte = 16;

struct Elements {
    const unsigned char* first;
    std::size_t stride;
    std::size_t count;
};

struct Layout {
    std::size_t offset;  // into the view
    std::size_t count;
    std::size_t elementSize;
};

// Finds the bytes of `count` elements. Refuses elements outside their view, and a view outside its buffer.
Elements findElements(const GltfFile& file, std::size_t viewIndex, const Layout& layout, const std::string& place)
{
    const tinygltf::BufferView& view = file.model.bufferViews[viewIndex];
    const std::string viewPlace = "bufferViews[" + std::to_string(viewIndex) + "]";
    const BufferRange range{static_cast<std::size_t>(view.buffer), view.byteOffset, view.byteLength};
    const std::span<const unsigned char> bytes = findBytes(file.path, file.buffers, range, viewPlace);
    const std::size_t stride = view.byteStride == 0 ? layout.elementSize : view.byteStride;
    if (stride < layout.elementSize) {
        refuse(file, MessageId::OutOfRange,
               {part::place(viewPlace + ".byteStride"), " is ", part::value(std::to_string(stride)), "; expected ",
                part::expected("at least the " + std::to_string(layout.elementSize) + " bytes of an element of " + place)});
    }
    const bool firstFits = layout.offset <= view.byteLength && layout.elementSize <= view.byteLength - layout.offset;
    const std::size_t room = firstFits ? (view.byteLength - layout.offset - layout.elementSize) / stride + 1 : 0;
    if (layout.count > room) {
        refuse(file, MessageId::OutOfRange,
               {part::place(place), " claims ", part::value(std::to_string(layout.count)), " elements; expected ",
                part::expected("at most the " + std::to_string(room) + " that fit into " + viewPlace)});
    }
    return {bytes.data() + layout.offset, stride, layout.count};
}

template <typename Component>
Component load(const unsigned char* bytes)
{
    Component value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

// glTF 2.0, section 3.6.2.2: signed normalised integers are clamped, so that both ends are exact.
template <typename Component>
double loadAs(const unsigned char* bytes, bool normalized)
{
    const auto value = static_cast<double>(load<Component>(bytes));
    if constexpr (std::is_integral_v<Component>) {
        return normalized ? std::max(value / static_cast<double>(std::numeric_limits<Component>::max()), -1.0) : value;
    }
    return value;
}

using Loader = double (*)(const unsigned char*, bool);

Loader findLoader(const GltfFile& file, int componentType, const std::string& place)
{
    switch (componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: return loadAs<std::int8_t>;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return loadAs<std::uint8_t>;
    case TINYGLTF_COMPONENT_TYPE_SHORT: return loadAs<std::int16_t>;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return loadAs<std::uint16_t>;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return loadAs<std::uint32_t>;
    case TINYGLTF_COMPONENT_TYPE_FLOAT: return loadAs<float>;
    default: break;
    }
    refuse(file, MessageId::WrongType,
           {part::place(place + ".componentType"), " is ", part::value(std::to_string(componentType)), "; expected ",
            part::expected("one of 5120, 5121, 5122, 5123, 5125 and 5126")});
}

void checkIndexType(const GltfFile& file, int componentType, const std::string& place)
{
    if (componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
        componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
        refuse(file, MessageId::WrongType,
               {part::place(place + ".componentType"), " is ", part::value(std::to_string(componentType)), "; expected ",
                part::expected("5121, 5123 or 5125 for indices")});
    }
}

// How to convert an element: the type of its components, and how many it has.
struct Decoder {
    Loader loader;
    std::size_t componentSize;
    std::size_t components;
    bool normalized;

    std::size_t size() const { return componentSize * components; }
    double operator()(const unsigned char* element, std::size_t component) const
    {
        return loader(element + component * componentSize, normalized);
    }
};

Decoder makeDecoder(const GltfFile& file, int componentType, std::size_t components, bool normalized, const std::string& place)
{
    return {findLoader(file, componentType, place),
            static_cast<std::size_t>(tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(componentType))), components, normalized};
}

// The elements that a sparse accessor replaces, in increasing order.
struct Sparse {
    Decoder indexDecoder;
    Elements indices, values;

    std::size_t target(std::size_t i) const { return static_cast<std::size_t>(indexDecoder(indices.first + i * indices.stride, 0)); }
    const unsigned char* value(std::size_t i) const { return values.first + i * values.stride; }
};

Sparse findSparse(const GltfFile& file, const tinygltf::Accessor& accessor, const Decoder& decoder, const std::string& place)
{
    const auto& sparse = accessor.sparse;
    const auto count = static_cast<std::size_t>(sparse.count);
    checkIndexType(file, sparse.indices.componentType, place + ".sparse.indices");
    const Decoder indexDecoder = makeDecoder(file, sparse.indices.componentType, 1, false, place);
    return {indexDecoder,
            findElements(file, static_cast<std::size_t>(sparse.indices.bufferView),
                         {static_cast<std::size_t>(sparse.indices.byteOffset), count, indexDecoder.size()}, place + ".sparse.indices"),
            findElements(file, static_cast<std::size_t>(sparse.values.bufferView),
                         {static_cast<std::size_t>(sparse.values.byteOffset), count, decoder.size()}, place + ".sparse.values")};
}

template <typename Value, typename Convert>
void replaceSparse(const GltfFile& file, const tinygltf::Accessor& accessor, const Decoder& decoder, const std::string& place,
                   const Convert& convert, std::vector<Value>& values)
{
    const Sparse sparse = findSparse(file, accessor, decoder, place);
    for (std::size_t i = 0; i < sparse.indices.count; ++i) {
        const std::size_t target = sparse.target(i);
        if (target >= values.size()) {
            refuse(file, MessageId::DanglingIndex,
                   {part::place(place + ".sparse"), " replaces element ", part::value(std::to_string(target)), "; expected ",
                    part::expected("one below " + std::to_string(values.size()))});
        }
        values[target] = convert(decoder, sparse.value(i));
    }
}

template <typename Value, typename Convert>
std::vector<Value> readElements(const GltfFile& file, std::size_t index, std::size_t components, const std::string& place,
                                const Convert& convert)
{
    const tinygltf::Accessor& accessor = file.model.accessors[index];
    const Decoder decoder = makeDecoder(file, accessor.componentType, components, accessor.normalized, place);
    std::vector<Value> values;
    if (accessor.bufferView >= 0) {
        const Elements elements =
            findElements(file, static_cast<std::size_t>(accessor.bufferView), {accessor.byteOffset, accessor.count, decoder.size()}, place);
        values.reserve(elements.count);
        for (std::size_t i = 0; i < elements.count; ++i) {
            values.push_back(convert(decoder, elements.first + i * elements.stride));
        }
    } else {
        constexpr unsigned char kZeros[16 * sizeof(float)] = {};
        values.resize(accessor.count, convert(decoder, kZeros));
    }
    if (accessor.sparse.isSparse) {
        replaceSparse(file, accessor, decoder, place, convert, values);
    }
    return values;
}

void checkAccessor(const GltfFile& file, std::size_t index, int type, const char* typeName, const std::string& place)
{
    const tinygltf::Accessor& accessor = file.model.accessors[index];
    if (accessor.type != type) {
        refuse(file, MessageId::WrongType, {part::place(place), " has another type; expected ", part::expected(typeName)});
    }
    if (accessor.count == 0) {
        refuse(file, MessageId::OutOfRange,
               {part::place(place + ".count"), " is ", part::value("0"), "; expected ", part::expected("at least 1")});
    }
    if (accessor.bufferView < 0 && accessor.count > kMaxUnbackedElements) {
        refuse(file, MessageId::TooLarge,
               {part::place(place), " claims ", part::value(std::to_string(accessor.count)), " elements without a bufferView; expected ",
                part::expected("at most " + std::to_string(kMaxUnbackedElements))});
    }
}

std::string placeOf(std::size_t accessor, const std::string& use) { return "accessors[" + std::to_string(accessor) + "] (" + use + ")"; }

}  // namespace

template <class Value>
std::vector<Value> readVectors(const GltfFile& file, std::size_t accessor, const std::string& use)
{
    const std::string place = placeOf(accessor, use);
    const int type = file.model.accessors[accessor].type;
    const bool short4 = std::is_same_v<Value, glm::vec4> && type == TINYGLTF_TYPE_VEC3;
    const int components = short4 ? 3 : Value::length();
    // tinygltf's number for a vector type is its count of components.
    checkAccessor(file, accessor, components, ("VEC" + std::to_string(components)).c_str(), place);
    const auto convert = [components](const Decoder& decoder, const unsigned char* bytes) {
        Value value(1);
        for (int c = 0; c < components; ++c) {
            value[c] = static_cast<typename Value::value_type>(decoder(bytes, static_cast<std::size_t>(c)));
        }
        return value;
    };
    return readElements<Value>(file, accessor, static_cast<std::size_t>(components), place, convert);
}

template std::vector<glm::dvec3> readVectors(const GltfFile&, std::size_t, const std::string&);
template std::vector<glm::vec2> readVectors(const GltfFile&, std::size_t, const std::string&);
template std::vector<glm::vec4> readVectors(const GltfFile&, std::size_t, const std::string&);
template std::vector<glm::dvec4> readVectors(const GltfFile&, std::size_t, const std::string&);

template <class Value>
std::vector<Value> readAttribute(const GltfFile& file, const std::map<std::string, int>& attributes, const std::string& attribute,
                                 const std::string& plural, std::size_t vertexCount, const std::string& place)
{
    const auto found = attributes.find(attribute);
    if (found == attributes.end()) {
        return {};
    }
    std::vector<Value> values = readVectors<Value>(file, static_cast<std::size_t>(found->second), attribute + " of " + place);
    if (values.size() != vertexCount) {
        refuse(file, MessageId::Mismatch,
               {part::place(place), " has ", part::value(std::to_string(values.size()) + " " + plural), "; expected ",
                part::expected("as many as its " + std::to_string(vertexCount) + " positions")});
    }
    return values;
}

using Attributes = std::map<std::string, int>;
template std::vector<glm::dvec3> readAttribute(const GltfFile&, const Attributes&, const std::string&, const std::string&, std::size_t,
                                               const std::string&);
template std::vector<glm::vec2> readAttribute(const GltfFile&, const Attributes&, const std::string&, const std::string&, std::size_t,
                                              const std::string&);
template std::vector<glm::vec4> readAttribute(const GltfFile&, const Attributes&, const std::string&, const std::string&, std::size_t,
                                              const std::string&);
template std::vector<glm::dvec4> readAttribute(const GltfFile&, const Attributes&, const std::string&, const std::string&, std::size_t,
                                               const std::string&);

std::vector<std::uint32_t> readIndices(const GltfFile& file, std::size_t accessor, const std::string& use)
{
    const std::string place = placeOf(accessor, use);
    checkAccessor(file, accessor, TINYGLTF_TYPE_SCALAR, "SCALAR", place);
    checkIndexType(file, file.model.accessors[accessor].componentType, place);
    const auto convert = [](const Decoder& decoder, const unsigned char* bytes) { return static_cast<std::uint32_t>(decoder(bytes, 0)); };
    return readElements<std::uint32_t>(file, accessor, 1, place, convert);
}

std::vector<double> readNumbers(const GltfFile& file, std::size_t accessor, std::size_t components, const std::string& use)
{
    const std::string place = placeOf(accessor, use);
    const bool scalar = components == 1;
    checkAccessor(file, accessor, scalar ? TINYGLTF_TYPE_SCALAR : static_cast<int>(components),
                  (scalar ? "SCALAR" : "VEC" + std::to_string(components)).c_str(), place);
    const auto convert = [components](const Decoder& decoder, const unsigned char* bytes) {
        glm::dvec4 value(0.0);
        for (std::size_t c = 0; c < components; ++c) {
            value[static_cast<int>(c)] = decoder(bytes, c);
        }
        return value;
    };
    std::vector<double> numbers;
    for (const glm::dvec4& value : readElements<glm::dvec4>(file, accessor, components, place, convert)) {
        for (std::size_t c = 0; c < components; ++c) {
            numbers.push_back(value[static_cast<int>(c)]);
            if (!std::isfinite(numbers.back())) {
                refuse(file, MessageId::OutOfRange,
                       {part::place(place), " holds ", part::value(toText(numbers.back())), " in element ",
                        std::to_string((numbers.size() - 1) / components), "; expected ", part::expected("finite numbers")});
            }
        }
    }
    return numbers;
}

double readLastNumber(const GltfFile& file, std::size_t index, const std::string& use)
{
    const std::string place = placeOf(index, use);
    checkAccessor(file, index, TINYGLTF_TYPE_SCALAR, "SCALAR", place);
    const tinygltf::Accessor& accessor = file.model.accessors[index];
    const Decoder decoder = makeDecoder(file, accessor.componentType, 1, accessor.normalized, place);
    const std::size_t last = accessor.count - 1;
    double number = 0.0;
    if (accessor.bufferView >= 0) {
        const Elements elements =
            findElements(file, static_cast<std::size_t>(accessor.bufferView), {accessor.byteOffset, accessor.count, decoder.size()}, place);
        number = decoder(elements.first + last * elements.stride, 0);
    }
    if (accessor.sparse.isSparse && accessor.sparse.count > 0) {
        const Sparse sparse = findSparse(file, accessor, decoder, place);
        const std::size_t end = sparse.indices.count - 1;
        number = sparse.target(end) == last ? decoder(sparse.value(end), 0) : number;
    }
    if (!std::isfinite(number)) {
        refuse(file, MessageId::OutOfRange,
               {part::place(place), " holds ", part::value(toText(number)), " in element ", std::to_string(last), "; expected ",
                part::expected("finite numbers")});
    }
    return number;
}

std::vector<glm::dmat4> readMatrices(const GltfFile& file, std::size_t accessor, const std::string& use)
{
    const std::string place = placeOf(accessor, use);
    checkAccessor(file, accessor, TINYGLTF_TYPE_MAT4, "MAT4", place);
    if (file.model.accessors[accessor].componentType != TINYGLTF_COMPONENT_TYPE_FLOAT) {  // others have padding
        refuse(file, MessageId::WrongType,
               {part::place(place + ".componentType"), " is ", part::value(std::to_string(file.model.accessors[accessor].componentType)),
                "; expected ", part::expected("5126 for matrices")});
    }
    const auto convert = [](const Decoder& decoder, const unsigned char* bytes) {
        glm::dmat4 matrix;
        for (int i = 0; i < 16; ++i) {
            matrix[i / 4][i % 4] = decoder(bytes, static_cast<std::size_t>(i));
        }
        return matrix;
    };
    return readElements<glm::dmat4>(file, accessor, 16, place, convert);
}

std::uint64_t countUnbacked(const GltfFile& file, std::size_t accessor)
{
    const tinygltf::Accessor& source = file.model.accessors[accessor];
    const auto isOwn = [&file](int view) {
        return view >= 0 && static_cast<std::size_t>(file.model.bufferViews[static_cast<std::size_t>(view)].buffer) < file.ownBuffers;
    };
    const auto& sparse = source.sparse;
    const bool hasOwnSparse = !sparse.isSparse || (isOwn(sparse.indices.bufferView) && isOwn(sparse.values.bufferView));
    return (isOwn(source.bufferView) ? 0 : source.count) + (hasOwnSparse ? 0 : static_cast<std::uint64_t>(sparse.count));
}

std::uint64_t countMostUnbacked(std::uint64_t ownBytes) { return kFewUnbacked + kUnbackedPerByte * ownBytes; }

void checkUnbacked(const GltfFile& file, const MessagePart& user, std::uint64_t count)
{
    if (const std::uint64_t most = countMostUnbacked(file.ownBytes); count > most) {
        refuse(file, MessageId::TooLarge,
               {user, " read ", part::value(std::to_string(count)), " elements that are compressed or have no bufferView; expected ",
                part::expected("at most " + std::to_string(most) + " in a file of this size")});
    }
}

}  // namespace glim
