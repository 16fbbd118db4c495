// What films are of: the identity that a render gives to its film.
#pragma once

#include "host/flatten/flat_scene.hpp"
#include "host/render/film.hpp"
#include "host/render/settings.hpp"

namespace glim {

struct SceneIdentity {
    explicit SceneIdentity(const FlatScene& scene);

    std::uint64_t fingerprint;
    bool sharesMeshes;  // which rounds otherwise than flattened ones
};

// A film without pixels, of the size that the settings ask for.
Film emptyFilm(const RenderSettings& settings);

FilmIdentity identityOf(const SceneIdentity& scene, const FlatCamera& camera, const RenderSettings& settings);

}  // namespace glim
