// The identity that a render gives to its film. film.hpp says how films are compared by it.
#pragma once

#include "host/flatten/flat_scene.hpp"
#include "host/gpu/device.hpp"
#include "host/gpu/embedded_shader.hpp"
#include "host/render/film.hpp"
#include "host/render/settings.hpp"

namespace glim {

// The scene's part of it, which takes time and which another camera leaves as it is.
struct SceneIdentity {
    explicit SceneIdentity(const FlatScene& scene);

    std::uint64_t fingerprint;
    bool sharesMeshes;  // which rounds otherwise than flattened ones
};

// A film without pixels, of the size that the settings ask for.
Film emptyFilm(const RenderSettings& settings);

FilmIdentity makeIdentity(const SceneIdentity& scene, const FlatCamera& camera, const RenderSettings& settings);

// The kernels that films come from.
std::vector<EmbeddedShader> filmKernels();
// Of these.
std::string kernelsFingerprint();

// Of what the device makes of probe_arithmetic, which is made for it as all kernels are (host/gpu/arithmetic.hpp). It is probed once per
// process, driver and arithmetic. Devices with equal fingerprints are taken to give equal bits; all that round to nearest are meant to.
std::string arithmeticFingerprint(Device& device);

}  // namespace glim
