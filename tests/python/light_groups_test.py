#!/usr/bin/env python3
"""Light groups: film.lights, film.regroup and film.light_covariance."""

import unittest

import numpy as np
from python_case import PythonCase, glim, scene

OPTIONS = {"size": (24, 16), "spp": 96, "sun": (170, 20, 2)}
GROUPS = {"key": "sun", "sky": ["environment"]}


class LightGroupsTest(PythonCase):
    @classmethod
    def setUpClass(cls):
        cls.film = glim.render(scene("cornell_gems"), light_group={**GROUPS, "lamp": "lamp*"}, environment=(.2, .3, .4), **OPTIONS)

    def test_lights_add_up_to_the_film(self):
        lights = self.film.lights
        self.assertEqual(list(lights), ["key", "sky", "lamp"])
        np.testing.assert_allclose(sum(lights.values()), self.film.rgb, rtol=1e-5)
        for light in lights.values():
            self.assertGreater(light.mean(), 1e-3)
        np.testing.assert_array_equal(self.film.arrays()["lights.sky"], lights["sky"])

    def test_a_regrouped_film_has_its_error(self):
        lights = self.film.lights
        film = self.film.regroup({"key": 3, "sky": (1, .5, 0)}, lamp=.25)
        factors = {"key": np.full(3, 3.), "sky": np.array([1, .5, 0]), "lamp": np.full(3, .25)}
        np.testing.assert_allclose(film.rgb, sum(factors[name] * lights[name] for name in lights), rtol=1e-5)
        variance = sum(factors[a] * factors[b] * self.film.light_covariance(a, b).astype(float) for a in lights for b in lights)
        # Camera and light paths are independent; their blocks are joined by Welch, which rounds degrees of freedom, not the variance.
        np.testing.assert_allclose(film.variance, variance, rtol=1e-3, atol=1e-4 * film.variance.max())
        self.assertGreater(film.error.rmse, 0)
        self.assertEqual(film.lights, {})
        self.assertNotEqual(film.digest, self.film.digest)

    def test_the_command_line_has_the_same_film(self):
        film, _ = self.command_line(scene("cornell_gems"), "--size", "24x16", "--spp", "96", "--sun", "170,20,2", "--environment", ".2,.3,.4",
                                    "--light-group", "key=sun", "--light-group", "sky=environment", "--light-group", "lamp=lamp*")
        self.assertEqual(film.digest, self.film.digest)
        self.assertEqual(film.regroup(key=2).digest, self.film.regroup(key=2).digest)

    def test_saved_films_keep_their_groups(self):
        self.film.save(self.path("a.exr"))
        self.assertEqual(list(glim.read(self.path("a.exr")).lights), ["key", "sky", "lamp"])

    def test_films_are_resumed_with_their_groups(self):
        few = glim.render(scene("cornell"), light_group="each", size=(8, 8), spp=64)
        more = glim.render(scene("cornell"), light_group="each", size=(8, 8), spp=96)
        self.assertEqual(few.resume(spp=96).digest, more.digest)

    def test_wrong_groups_and_factors_are_refused(self):
        for factors in ({"sun": 1}, {"key": -1}, {"key": float("nan")}, {"key": float("inf")}):
            with self.assertRaises(glim.InputError):
                self.film.regroup(factors)
        with self.assertRaises(glim.InputError):
            self.film.light_covariance("key", "moon")
        with self.assertRaises(glim.InputError):
            glim.render(scene("cornell"), light_group={"key": "moon"}, size=(8, 8), spp=1)
        self.assertEqual(glim.render(scene("cornell"), size=(8, 8), spp=1).lights, {})


if __name__ == "__main__":
    import sys
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
