#include "host/render/film_identity.hpp"

#include "host/render/film_origin.hpp"

namespace glim {

SceneIdentity::SceneIdentity(const FlatScene& scene)
    : fingerprint(glim::fingerprint(scene)),
      sharesMeshes((scene.features & kFeatureInstances) != 0)
{}

Film emptyFilm(const RenderSettings& settings)
{
    Film film;
    film.width = settings.width;
    film.height = settings.rowCount();
    film.rowsAbove = settings.rowBegin();
    film.rowsBelow = settings.height - settings.rowBegin() - settings.rowCount();
    return film;
}

FilmIdentity identityOf(const SceneIdentity& scene, const FlatCamera& camera, const RenderSettings& settings)
{
    return {fingerprint(scene.fingerprint, camera), describeSettings(settings) + (scene.sharesMeshes ? " meshes=shared" : ""),
            settings.seed, kernelsFingerprint()};
}

}  // namespace glim
