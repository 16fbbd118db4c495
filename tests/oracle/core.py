"""The opaque glTF material: one GGX lobe, its multiple scattering and a diffuse lobe coupled to them reciprocally.

Sources: glTF 2.0, appendix B (metallic-roughness); KHR_materials_specular, _ior, _anisotropy, _pbrSpecularGlossiness; Kulla and Conty,
"Revisiting Physically Based Shading at Imageworks" (2017) for multiple scattering and for the form of the coupling.
Appendix B takes the metallic mix of two BRDFs; Schlick is linear in (F0, F90), so their GGX lobes are one lobe of mixed F0 and F90.
"""

from dataclasses import dataclass

import numpy as np

import ggx
from directions import dot, half_vector, per_channel, rotate_z, sample_cosine_hemisphere
from fresnel import schlick, schlick_average, specular_f0

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])  # Rec. 709
MIN_PROBABILITY = 0.02


@dataclass(frozen=True)
class Lobes:
    """f0 and diffuse have a value per channel (3,); rotation: of the tangent, counterclockwise, in radians.

    coupling_f0 and coupling_f90 describe the interface over the diffuse lobe, by its most reflective channel.
    """

    alpha_x: float
    alpha_y: float
    f0: np.ndarray
    f90: float
    diffuse: np.ndarray
    coupling_f0: float
    coupling_f90: float
    rotation: float = 0.0

    @property
    def isotropic(self):
        return self.alpha_x == self.alpha_y

    @property
    def curves(self):
        """The albedos of the GGX lobe, functions of what `place` returns."""
        if self.isotropic:
            return ggx.albedo_curves(float(self.alpha_x))
        return ggx.anisotropic_albedo(float(self.alpha_x), float(self.alpha_y))

    def place(self, w):
        """|cos| of directions (..., 3); of an anisotropic lobe the directions, mirrored to the upper side, in its frame."""
        return np.abs(w[..., 2]) if self.isotropic else rotate_z(w, -self.rotation) * np.where(w[..., 2:] < 0, [1, 1, -1], 1)


def anisotropic_alpha(roughness, strength):
    """(alpha along the tangent, alpha along the bitangent): KHR_materials_anisotropy."""
    alpha = roughness**2
    return alpha + (1 - alpha) * strength**2, alpha


def metallic_roughness(base, metallic=0.0, roughness=1.0, ior=1.5, specular=1.0, specular_color=(1, 1, 1), anisotropy=0.0, rotation=0.0):
    """The lobes of glTF 2.0 with KHR_materials_specular, _ior and _anisotropy; base (3,) is linear."""
    base = np.asarray(base, float)
    f0, f90 = specular_f0(ior, specular, specular_color)
    return Lobes(*anisotropic_alpha(roughness, anisotropy), f0 + (base - f0) * metallic, f90 + (1 - f90) * metallic,
                 base * (1 - metallic), np.max(f0), f90, rotation)


def specular_glossiness(diffuse, specular, glossiness):
    """The lobes of KHR_materials_pbrSpecularGlossiness; diffuse and specular (3,) are linear."""
    specular = np.asarray(specular, float)
    alpha = (1 - glossiness) ** 2
    return Lobes(alpha, alpha, specular, 1.0, np.asarray(diffuse, float) * (1 - np.max(specular)), np.max(specular), 1.0)


def multiple_scattering_fresnel(curves, f0, f90):
    """The share that further bounces reflect in all, per channel; 1 for F = 1. Kulla and Conty (2017)."""
    f_avg = schlick_average(np.asarray(f0, float), f90)
    return f_avg**2 * curves.E1_avg / (1 - f_avg * (1 - curves.E1_avg))


def specular_albedo(place, curves, f0, f90):
    """Directional albedo of the GGX lobe with multiple scattering, (..., 3) or (..., 1) as f0 has channels; place: Lobes.place."""
    a, b = per_channel(curves.A(place)), per_channel(curves.B(place))
    return f0 * a + f90 * b + multiple_scattering_fresnel(curves, f0, f90) * (1 - a - b)


def specular_albedo_average(curves, f0, f90):
    """The cosine average of specular_albedo."""
    return f0 * curves.A_avg + f90 * curves.B_avg + multiple_scattering_fresnel(curves, f0, f90) * (1 - curves.E1_avg)


def interface_albedo(place, lobes):
    """Ed: what the interface over the diffuse lobe keeps from it."""
    return specular_albedo(place, lobes.curves, lobes.coupling_f0, lobes.coupling_f90)[..., 0]


def diffuse_coupling(v, l, lobes):
    """(1 - Ed(v)) (1 - Ed(l)) / (pi (1 - Ed_avg)) in 1/sr, v and l on any side; 0 under an interface that reflects everything."""
    passed = 1 - specular_albedo_average(lobes.curves, lobes.coupling_f0, lobes.coupling_f90)
    if passed < 1e-12:
        return np.zeros(np.broadcast_shapes(v.shape, l.shape)[:-1])
    return (1 - interface_albedo(lobes.place(v), lobes)) * (1 - interface_albedo(lobes.place(l), lobes)) / (np.pi * passed)


def eval_single_scattering(v, l, lobes):
    """F V D |nl| in 1/sr, per channel (..., 3); Schlick's Fresnel. v and l relative to the tangent frame before its rotation."""
    v, l = rotate_z(v, -lobes.rotation), rotate_z(l, -lobes.rotation)
    f = schlick(per_channel(dot(v, half_vector(v, l))), lobes.f0, lobes.f90)
    return f * per_channel(ggx.eval(v, l, lobes.alpha_x, lobes.alpha_y))


def eval_multiple_scattering(v, l, lobes):
    """Fms (1 - E1(v)) (1 - E1(l)) / (pi (1 - E1_avg)) |nl| in 1/sr, per channel (..., 3): Kulla and Conty (2017)."""
    curves = lobes.curves
    lost = (1 - curves.E1(lobes.place(v))) * (1 - curves.E1(lobes.place(l))) / (np.pi * (1 - curves.E1_avg))
    return multiple_scattering_fresnel(curves, lobes.f0, lobes.f90) * per_channel(lost * np.maximum(l[..., 2], 0))


def eval_diffuse(v, l, lobes):
    """The coupled diffuse lobe times |nl| in 1/sr, per channel (..., 3)."""
    return lobes.diffuse * per_channel(diffuse_coupling(v, l, lobes) * np.maximum(l[..., 2], 0))


def eval(v, l, lobes):
    """The BSDF times |nl| in 1/sr, per channel (..., 3); v on the upper side, 0 for l below the horizon."""
    return eval_single_scattering(v, l, lobes) + eval_multiple_scattering(v, l, lobes) + eval_diffuse(v, l, lobes)


def specular_probability(v, lobes):
    """The probability to sample the GGX lobe, by luminance of the albedos; neither lobe falls below MIN_PROBABILITY unless it is black."""
    specular = specular_albedo(lobes.place(v), lobes.curves, lobes.f0, lobes.f90) @ LUMINANCE
    diffuse = (per_channel(1 - interface_albedo(lobes.place(v), lobes)) * lobes.diffuse) @ LUMINANCE
    if np.all(lobes.diffuse == 0):
        return np.ones_like(v[..., 2])
    if np.all(lobes.f0 == 0) and lobes.f90 == 0:
        return np.zeros_like(v[..., 2])
    return np.clip(specular / (specular + diffuse), MIN_PROBABILITY, 1 - MIN_PROBABILITY)


def pdf(v, l, lobes):
    """Density of sample in solid angle: the mixture of visible normals and cosine, which eval is divided by."""
    p = specular_probability(v, lobes)
    v, l = rotate_z(v, -lobes.rotation), rotate_z(l, -lobes.rotation)
    return p * ggx.pdf(v, l, lobes.alpha_x, lobes.alpha_y) + (1 - p) * np.maximum(l[..., 2], 0) / np.pi


def sample(v, lobes, u):
    """Directions (n, 3) for one v (3,) and u (n, 3), whose last column chooses the lobe."""
    reflected = ggx.sample(rotate_z(v, -lobes.rotation), lobes.alpha_x, lobes.alpha_y, u[:, :2])
    specular = u[:, 2] < specular_probability(v, lobes)
    return np.where(per_channel(specular) > 0, rotate_z(reflected, lobes.rotation), sample_cosine_hemisphere(u[:, :2]))
