#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/scene_on_device.hpp"
#include "tests/support/test_meshes.hpp"
#include "tests/support/wrapped_texel.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace glim::texture_test {

struct Case {
    std::uint32_t texture = 0;
    glm::vec4 uv{0.0F};
    std::uint32_t texel = 0;
};

struct Result {
    glm::vec4 value;
    uvec4 fetched;
};

DecodedImage randomImage(std::uint32_t width, std::uint32_t height, bool wide, Random& random)
{
    DecodedImage image;
    image.width = width;
    image.height = height;
    for (std::size_t i = 0; i < std::size_t{4} * width * height; ++i) {
        if (wide) {
            image.rgba16.push_back(static_cast<std::uint16_t>(random.below(65536)));
        } else {
            image.rgba8.push_back(static_cast<std::uint8_t>(random.below(256)));
        }
    }
    return image;
}

glm::dvec4 texelOf(const DecodedImage& image, double x, double y, const Texture& texture, bool srgb)
{
    const auto wrapOf = [](Wrap wrap) { return wrap == Wrap::Clamp ? kClamp : wrap == Wrap::Mirrored ? kMirrored : kRepeat; };
    const std::size_t at = 4 * (std::size_t{test::wrappedTexel(y, image.height, wrapOf(texture.wrapT))} * image.width +
                                test::wrappedTexel(x, image.width, wrapOf(texture.wrapS)));
    glm::dvec4 value;
    for (std::size_t c = 0; c < 4; ++c) {
        const double v = image.rgba16.empty() ? image.rgba8[at + c] / 255.0 : image.rgba16[at + c] / 65535.0;
        value[static_cast<int>(c)] = srgb && c < 3 ? test::linearFromSrgb(v) : v;
    }
    return value;
}

// In double; `edge`: how far the point is from where a nearest texel changes, in texels.
glm::dvec4 expectedOf(const DecodedImage& image, const Texture& texture, bool srgb, const glm::vec4& uv, double& edge)
{
    const glm::dvec3 at(texture.uvSet == 1 ? uv.z : uv.x, texture.uvSet == 1 ? uv.w : uv.y, 1.0);
    const double x = glm::dot(glm::dvec3(texture.rowU), at) * image.width, y = glm::dot(glm::dvec3(texture.rowV), at) * image.height;
    edge = std::min(std::abs(x - std::round(x)), std::abs(y - std::round(y)));
    if (texture.nearest) {
        return texelOf(image, std::floor(x), std::floor(y), texture, srgb);
    }
    const double left = std::floor(x - 0.5), top = std::floor(y - 0.5), s = x - 0.5 - left, t = y - 0.5 - top;
    const auto texel = [&](double i, double j) { return texelOf(image, i, j, texture, srgb); };
    return (1.0 - t) * ((1.0 - s) * texel(left, top) + s * texel(left + 1.0, top)) +
           t * ((1.0 - s) * texel(left, top + 1.0) + s * texel(left + 1.0, top + 1.0));
}

// glTF's KHR_texture_transform: translation times rotation times scale.
void setTransform(Texture& texture, double angle, const glm::dvec2& scale, const glm::dvec2& offset)
{
    const double c = std::cos(angle), s = std::sin(angle);
    texture.rowU = glm::vec3(glm::dvec3(c * scale.x, s * scale.y, offset.x));
    texture.rowV = glm::vec3(glm::dvec3(-s * scale.x, c * scale.y, offset.y));
}

// Two materials for each texture: one has it as base colour, in sRGB, one as specular strength.
Scene makeTestScene(const std::vector<Texture>& textures, const std::vector<DecodedImage>& images)
{
    Scene scene = makeTestScene(icosphere(0));
    for (const DecodedImage& image : images) {
        scene.images.push_back({"image", image});
    }
    for (const Texture& texture : textures) {
        scene.materials.emplace_back().textures[kSlotBaseColor] = texture;
        scene.materials.emplace_back().textures[kSlotSpecular] = texture;
    }
    return scene;
}

std::vector<Result> lookedUp(const SceneOnDevice& scene, const std::vector<Case>& cases)
{
    KernelTest test = scene.test(test_kernels::texture_test);
    test.features(kAllFeatures);  // no surface has these materials
    test.cases(cases).resultsOf<Result>(cases.size()).run();
    return test.results<Result>();
}

const Wrap kWraps[] = {Wrap::Repeat, Wrap::Mirrored, Wrap::Clamp};

// Every way to wrap, filter, transform and store, in both roles and from both sets of coordinates.
TEST(TextureTest, H36LookUpsAsInDouble)
{
    Random random(11);
    const std::vector<DecodedImage> images = {randomImage(7, 5, false, random), randomImage(16, 1, false, random),
                                              randomImage(4, 6, true, random), randomImage(64, 32, true, random)};
    std::vector<Texture> textures;
    for (std::uint32_t image = 0; image < images.size(); ++image) {
        for (const Wrap s : kWraps) {
            for (const Wrap t : kWraps) {
                for (const bool nearest : {false, true}) {
                    Texture texture{image, static_cast<std::uint32_t>(textures.size() / 2 % 2), s, t, nearest};
                    if (textures.size() % 3 != 0) {
                        setTransform(texture, random.uniform(-4.0, 4.0), {random.uniform(-2.0, 2.0), random.uniform(0.2, 2.0)},
                                     {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)});
                    }
                    textures.push_back(texture);
                }
            }
        }
    }
    const SceneOnDevice scene(makeTestScene(textures, images));
    const std::size_t firstPrincipled = scene.flat.principled.size() - 2 * textures.size();
    struct Expected {
        glm::dvec4 value;
        double edge;
    };
    std::vector<Case> cases;
    std::vector<Expected> expected;
    for (std::size_t i = 0; i < textures.size(); ++i) {
        for (const bool srgb : {true, false}) {
            const PrincipledData& data = scene.flat.principled.at(firstPrincipled + 2 * i + (srgb ? 0 : 1));
            for (int k = 0; k < 100; ++k) {
                Case c;
                c.texture = data.firstTexture;
                c.uv =
                    glm::dvec4(random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5));
                Expected e{};
                e.value = expectedOf(images[textures[i].image], textures[i], srgb, c.uv, e.edge);
                if (!textures[i].nearest || e.edge > 1e-4) {
                    cases.push_back(c);
                    expected.push_back(e);
                }
            }
        }
    }
    const std::vector<Result> results = lookedUp(scene, cases);
    double worst = 0.0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const glm::dvec4 error = glm::abs(glm::dvec4(results[i].value) - expected[i].value);
        worst = std::max({worst, error.x, error.y, error.z, error.w});
    }
    EXPECT_LE(worst, 1e-5 + 64.0 * 4.0 * 0x1p-24);  // the coordinates are up to 4, rounded, and the widest image has 64 texels
    printHardCase("H36", "look-ups, all modes, 8 and 16 bits", static_cast<double>(cases.size()), "within " + figure(worst));
}

// Each of the eight views is read, at its own texels, however many a device's views have.
class TexelViewTest : public testing::TestWithParam<std::uint32_t> {};

TEST_P(TexelViewTest, TexelsOfEveryView)
{
    const std::uint32_t bits = GetParam();
    constexpr std::uint32_t kTexels = 3;
    std::vector<Buffer> views;
    for (std::uint32_t view = 0; view < kMaxTexelViews; ++view) {
        std::vector<std::uint32_t> texels;
        for (std::uint32_t i = 0; i < kTexels; ++i) {
            texels.push_back(view | i << 8U | 0xab0000U | (255U - view) << 24U);
        }
        views.emplace_back(testDevice(), "test texels", BufferKind::Texel4, kTexels * sizeof(std::uint32_t));
        upload(views.back(), std::span<const std::uint32_t>(texels));
    }
    std::vector<Case> cases;
    for (std::uint32_t view = 0; view < kMaxTexelViews; ++view) {
        for (std::uint32_t i = 0; i < kTexels; ++i) {
            cases.push_back({0, glm::vec4(0.0F), view << bits | i});
        }
    }
    const SceneOnDevice scene(makeTestScene(icosphere(0)));
    for (const std::uint32_t bound : {kMaxTexelViews, 2U}) {
        std::map<std::uint32_t, const Buffer*> buffers;
        for (std::uint32_t view = 0; view < kMaxTexelViews; ++view) {
            buffers[kBindTexels + view] = &views[view];
        }
        KernelTest test(test_kernels::texture_test);
        test.buffers(buffers).buffers(scene.device.buffers()).specialize(kSpecTexelViews, bound).specialize(kSpecTexelViewBits, bits);
        test.cases(cases).resultsOf<Result>(cases.size()).run();
        const std::vector<Result> results = test.results<Result>();
        for (std::size_t i = 0; i < bound * kTexels; ++i) {
            const auto view = static_cast<std::uint32_t>(i / kTexels), at = static_cast<std::uint32_t>(i % kTexels);
            EXPECT_EQ(results[i].fetched, uvec4(view, at, 0xab, 255U - view)) << bound << " views, texel " << at << " of view " << view;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Bits, TexelViewTest, testing::Values(2U, 16U, 26U, kMaxTexelViewBits));

}  // namespace glim::texture_test
