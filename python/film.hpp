// Films as Python sees them.
#pragma once

#include "host/image/image.hpp"
#include "host/job/denoising.hpp"
#include "host/render/film_file.hpp"
#include "host/render/identify.hpp"

#include <nanobind/nanobind.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace glim {

// A film that never changes, so that arrays may be views of it.
class PythonFilm {
public:
    // `checkpoint`: what a render needs to go on from besides the film.
    PythonFilm(Film film, std::optional<Checkpoint> checkpoint);

    const Film& film() const { return film_; }
    StoredFilm stored() const { return {film_, checkpoint_}; }
    // What the film shows, row 0 at the top.
    const std::vector<PixelMoments>& pixels() const { return film_.splats.empty() ? film_.pixels : shown_; }

    void setDenoising(std::optional<Denoising> denoising) { denoising_ = std::move(denoising); }
    const std::optional<Denoising>& denoising() const { return denoising_; }
    void identify(Identifier& identifier);
    // Indices in the scene's file, by "node", "mesh" and "material"; empty unless identify() was called.
    const std::map<std::string, std::vector<std::uint32_t>>& ids() const { return ids_; }
    // Layers of surfaces.hpp.
    void setSurfaces(Image surfaces) { surfaces_ = std::move(surfaces); }
    const std::optional<Image>& surfaces() const { return surfaces_; }
    // JSON of seen_instances.hpp.
    void setObjects(std::string objects) { objects_ = std::move(objects); }
    const std::optional<std::string>& objects() const { return objects_; }

private:
    Film film_;
    std::optional<Checkpoint> checkpoint_;
    std::vector<PixelMoments> shown_;
    std::optional<Denoising> denoising_;
    std::map<std::string, std::vector<std::uint32_t>> ids_;
    std::optional<Image> surfaces_;
    std::optional<std::string> objects_;
};

void bindFilm(nanobind::module_& module);

}  // namespace glim
