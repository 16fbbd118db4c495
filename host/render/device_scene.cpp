#include "host/render/device_scene.hpp"

#include "shaders/shared/bindings.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace glim {
namespace {

// A buffer cannot be empty: an array that the scene does not need gets one zero element.
template <class T>
Buffer uploaded(Device& device, const std::string& name, BufferKind kind, const std::vector<T>& values)
{
    const std::vector<T> one(1, T{});
    const std::vector<T>& source = values.empty() ? one : values;
    Buffer buffer(device, name, kind, source.size() * sizeof(T));
    upload(buffer, std::span<const T>(source));
    return buffer;
}

// The array on the device, where it may be already.
DeviceArray upload(Device& device, const std::string& name, const SharedVector<uvec4>& values, DeviceArray before)
{
    if (before.buffer && before.source.is(values)) {
        return before;
    }
    before = {};  // so that no two are on the device
    return {SharedVector<uvec4>::Identity(values),
            std::make_shared<const Buffer>(uploaded<uvec4>(device, name, BufferKind::Texel, values))};
}

LastingBuffers upload(Device& device, const FlatScene& scene, LastingBuffers before)
{
    return {before.textures && before.textures->serve(scene) ? std::move(before.textures) : std::make_shared<DeviceTextures>(device, scene),
            upload(device, "scene's BVH nodes", scene.nodes, std::move(before.nodes)),
            upload(device, "scene's primitive references", scene.primitiveRefs, std::move(before.primitiveRefs)),
            upload(device, "scene's triangles for shading", scene.triangles, std::move(before.triangles)),
            upload(device, "scene's vertices", scene.vertices, std::move(before.vertices)),
            upload(device, "scene's instances", scene.instances, std::move(before.instances)),
            upload(device, "scene's motions", scene.motions, std::move(before.motions))};
}

// Arrays of whole texels, one behind the other.
template <class... T>
std::vector<uvec4> toTexels(const std::vector<T>&... arrays)
{
    std::vector<uvec4> texels;
    const auto append = [&texels](const auto& values) {
        const std::size_t before = texels.size();
        texels.resize(before + values.size() * sizeof(values[0]) / sizeof(uvec4));
        if (!values.empty()) {
            std::memcpy(&texels[before], values.data(), values.size() * sizeof(values[0]));
        }
    };
    (append(arrays), ...);
    return texels;
}

std::vector<Buffer> uploadImages(Device& device, const std::vector<std::uint32_t>& texels)
{
    const std::size_t perView = std::size_t{1} << texelViewBits(device.description());
    if (texels.size() > kMaxTexelViews * perView) {
        throw DeviceError(MessageId::DeviceLimit,
                          {"The ", part::place("scene's textures"), " need ", part::value(std::to_string(texels.size())),
                           " texels, but device \"", device.description().name, "\" holds ",
                           part::expected(std::to_string(kMaxTexelViews * perView)), "; --max-texture N scales them down."});
    }
    std::vector<Buffer> views;
    for (std::size_t first = 0; first < texels.size(); first += perView) {
        const std::span<const std::uint32_t> part = std::span(texels).subspan(first, std::min(perView, texels.size() - first));
        views.emplace_back(device, "scene's textures", BufferKind::Texel4, part.size_bytes());
        upload(views.back(), part);
    }
    if (views.empty()) {
        views.push_back(uploaded(device, "scene's textures", BufferKind::Texel4, texels));
    }
    return views;
}

}  // namespace

std::uint32_t texelViewBits(const DeviceDescription& device)
{
    const std::uint64_t texels = std::min(device.maxTexelElements, std::uint64_t{1} << kMaxTexelViewBits);
    return static_cast<std::uint32_t>(std::bit_width(texels)) - 1;
}

DeviceTextures::DeviceTextures(Device& device, const FlatScene& scene)
    : images_(scene.images),
      environmentMap_(scene.environmentMap),
      imageViews_(uploadImages(device, images_->texels)),
      environment_(uploaded(device, "environment map", BufferKind::Texel8, environmentMap_->texels)),
      environmentCells_(uploaded(device, "environment map's cells", BufferKind::Texel, environmentMap_->cells))
{}

void DeviceTextures::addTo(std::map<std::uint32_t, const Buffer*>& buffers) const
{
    buffers[kBindEnvironment] = &environment_;
    buffers[kBindEnvironmentCells] = &environmentCells_;
    for (std::uint32_t view = 0; view < kMaxTexelViews; ++view) {
        buffers[kBindTexels + view] = &imageViews_[std::min<std::size_t>(view, imageViews_.size() - 1)];
    }
}

DeviceScene::DeviceScene(Device& device, const FlatScene& scene, LastingBuffers lasting)
    : lasting_(upload(device, scene, std::move(lasting))),
      materials_(uploaded(device, "scene's materials", BufferKind::Texel,
                          toTexels(scene.materials, scene.principled, scene.layers, scene.textures, scene.media, scene.scattering))),
      lights_(uploaded(device, "scene's lights", BufferKind::Texel, toTexels(scene.lights, scene.lightPowers))),
      lightNodes_(uploaded(device, "scene's light tree", BufferKind::Texel, scene.lightNodes)),
      albedos_(uploaded(device, "albedo table", BufferKind::Texel, scene.albedos)),
      caustics_(uploaded(device, "targets of light paths", BufferKind::Texel, scene.caustics))
{}

std::vector<BindingSlot> DeviceScene::slots()
{
    std::vector<BindingSlot> slots{{kBindEnvironment, BufferKind::Texel8}};
    for (const std::uint32_t binding :
         {kBindNodes, kBindPrimitiveRefs, kBindTriangles, kBindVertices, kBindMaterials, kBindLights, kBindLightNodes, kBindAlbedos,
          kBindEnvironmentCells, kBindCaustics, kBindInstances, kBindMotions}) {
        slots.push_back({binding, BufferKind::Texel});
    }
    for (std::uint32_t view = 0; view < kMaxTexelViews; ++view) {
        slots.push_back({kBindTexels + view, BufferKind::Texel4});
    }
    return slots;
}

std::map<std::uint32_t, const Buffer*> DeviceScene::buffers() const
{
    std::map<std::uint32_t, const Buffer*> buffers{{kBindNodes, lasting_.nodes.buffer.get()},
                                                   {kBindPrimitiveRefs, lasting_.primitiveRefs.buffer.get()},
                                                   {kBindTriangles, lasting_.triangles.buffer.get()},
                                                   {kBindVertices, lasting_.vertices.buffer.get()},
                                                   {kBindMaterials, &materials_},
                                                   {kBindLights, &lights_},
                                                   {kBindLightNodes, &lightNodes_},
                                                   {kBindAlbedos, &albedos_},
                                                   {kBindCaustics, &caustics_},
                                                   {kBindInstances, lasting_.instances.buffer.get()},
                                                   {kBindMotions, lasting_.motions.buffer.get()}};
    lasting_.textures->addTo(buffers);
    return buffers;
}

}  // namespace glim
