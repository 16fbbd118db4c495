#!/usr/bin/env python3
"""`import glim`: the bits of the command line, lifetimes, threads, Ctrl-C."""

import gc
import json
import os
import pickle
import shutil
import signal
import subprocess
import sys
import threading
import time
import unittest
import warnings
import weakref

import numpy as np
from python_case import GEMS, GLIM, ROOT, PythonCase, glim, run_python, scene


class BitsTest(PythonCase):
    def test_of_the_command_line(self):
        gems = glim.load(GEMS, size=(24, 16))
        for words, options in ((["--spp", "80"], {"spp": 80}),
                               (["--spp", "8", "--seed", "3"], {"spp": np.int64(8), "seed": 3}),
                               (["--spp", "8", "--look-from", "0,1,3", "--look-at", "0.0,1.0,0.0", "--look-up", "0,1,0", "--zoom", "1.0"],
                                {"spp": 8, **glim.look_at(np.array([0, 1, 3]), (0.0, 1.0, 0.0))}),
                               (["--target-rmse", "9%"], {"target_rmse": .09}),
                               (["--spp", "128", "--adaptive", "neighbours"], {"spp": 128, "adaptive": "neighbours"}),
                               (["--samples", "256:300", "--caustics", "off"], {"samples": (256, 300), "caustics": False}),
                               (["--spp", "4", "--rows", "3:7"], {"spp": 4, "rows": (3, 7)})):
            film, _ = self.command_line(GEMS, "--size", "24x16", *words)
            self.assertEqual(gems.render(**options).digest, film.digest, words)

    def test_error_of_the_command_line(self):
        film, stats = self.command_line(GEMS, "--size", "24x16", "--spp", "80")
        error, estimate = film.error, stats["estimate"]
        self.assertEqual((error.rmse, error.rel_mse, error.mse, error.mean),
                         tuple(estimate[name] for name in ("rmseOfMean", "relmse", "mse", "mean")))
        self.assertEqual([error.rmse_low, error.rmse_high, error.rel_mse_low, error.rel_mse_high],
                         [*estimate["rmseOfMean95"], *estimate["relmse95"]])
        self.assertIsNone(glim.render(GEMS, size="8x8", spp=4).error)

    def test_a_changed_file_is_read_again(self):
        path = self.path("scene.gltf")
        shutil.copy(scene("cornell"), path)
        for name in os.listdir(os.path.join(ROOT, "scenes")):
            if name.startswith("cornell") and name.endswith(".bin"):
                shutil.copy(os.path.join(ROOT, "scenes", name), self.folder)
        kept = glim.load(path, size="8x8", spp=4)
        before = kept.render().digest
        with open(path, encoding="utf-8") as file:
            text = file.read()
        with open(path, "w", encoding="utf-8") as file:
            file.write(text.replace('"baseColorFactor"', '"extras"', 1))
        self.assertNotEqual(kept.render().digest, before)
        self.assertEqual(kept.render().digest, glim.render(path, size="8x8", spp=4).digest)


class FilmTest(PythonCase):
    def test_layers(self):
        film = glim.render(scene("cornell"), size=(20, 12), spp=70, ids=True)
        for name, shape, kind in (("rgb", (12, 20, 3), "float32"), ("alpha", (12, 20), "float32"), ("albedo", (12, 20, 3), "float32"),
                                  ("normal", (12, 20, 3), "float32"), ("depth", (12, 20), "float32"), ("count", (12, 20), "uint32"),
                                  ("variance", (12, 20, 3), "float32")):
            layer = getattr(film, name)
            self.assertEqual((layer.shape, str(layer.dtype)), (shape, kind), name)
            self.assertFalse(layer.flags.writeable, name)
        self.assertTrue((film.count == 70).all())
        self.assertTrue(np.isfinite(film.variance).all() and (film.variance >= 0).all())
        # The middle of the bottom row sees the floor of the box, which is white and looks up.
        self.assertEqual(list(film.normal[-1, 7].round(4)), [0, 1, 0])
        self.assertEqual(film.alpha[-1, 7], 1)
        self.assertTrue(.5 < film.albedo[-1, 7].min() < 1 and 0 < film.depth[-1, 7] < 100)
        # The films that it can be read back from have the same layers.
        film.save(self.path("film.exr"))
        again = glim.read(self.path("film.exr"))
        self.assertEqual(again.digest, film.digest)
        for name in ("rgb", "alpha", "albedo", "normal", "depth", "count", "variance"):
            self.assertTrue(np.array_equal(getattr(again, name), getattr(film, name)), name)
        self.assertEqual(sorted(film.ids), ["material", "mesh", "node"])
        with open(scene("cornell"), encoding="utf-8") as file:
            document = json.load(file)
        node = film.ids["node"][-1, 7]
        self.assertEqual(film.ids["mesh"][-1, 7], document["nodes"][node]["mesh"])
        self.assertIsNone(again.ids)

    def test_mean_is_of_the_samples(self):
        """Radiance, not its neighbour in memory: a white environment alone is 1 everywhere."""
        film = glim.render(scene("cornell"), size=(8, 8), spp=4, bounces=0, environment=(1, 1, 1), **glim.look_at((0, 50, 0), (0, 99, 1)))
        self.assertTrue((film.rgb == 1).all() and (film.alpha == 0).all() and np.isinf(film.depth).all())

    def test_views_outlive_the_film(self):
        film = glim.render(GEMS, size=(64, 64), spp=2)
        view, expected = film.rgb, film.rgb.copy()
        self.assertTrue(np.shares_memory(view, film.rgb))
        ids = glim.render(GEMS, size=(64, 64), spp=2, ids=True).ids["node"]
        expected_ids = ids.copy()
        del film
        gc.collect()
        others = [glim.render(GEMS, size=(64, 64), spp=2, seed=seed) for seed in range(1, 4)]
        self.assertTrue(np.array_equal(view, expected) and np.array_equal(ids, expected_ids))
        self.assertFalse(any(np.array_equal(view, other.rgb) for other in others))

    def test_merge(self):
        kept = glim.load(GEMS, size=(16, 12))
        parts = [kept.render(samples=samples) for samples in ((256, 300), (0, 256))]
        merged = glim.merge(parts)
        self.assertTrue(merged.exact)
        self.assertEqual(merged.digest, kept.render(spp=300).digest)
        self.assertFalse(glim.merge([kept.render(samples=(0, 70)), kept.render(samples=(70, 90))]).exact)
        bands = [kept.render(spp=4, rows=rows) for rows in ((5, 12), (0, 5))]
        self.assertEqual(glim.merge(bands).digest, kept.render(spp=4).digest)
        with self.assertRaisesRegex(glim.InputError, "both hold samples 0:256"):
            glim.merge([parts[1], parts[1]])
        with self.assertRaisesRegex(glim.InputError, "no films"):
            glim.merge([])

    def test_pictures(self):
        film = glim.render(scene("cornell"), size=(1100, 10), spp=1)
        film.save(self.path("film.png"), exposure=1)
        with open(self.path("film.png"), "rb") as file:
            self.assertEqual(file.read(24)[-8:], (1100).to_bytes(4, "big") + (10).to_bytes(4, "big"))
        for name, begin in (("film.jpg", b"\xff\xd8\xff"), ("film.WEBP", b"RIFF"), ("agx.png", b"\x89PNG")):
            film.save(self.path(name), exposure="auto", tone="agx")
            with open(self.path(name), "rb") as file:
                self.assertEqual(file.read(len(begin)), begin)
        with open(self.path("agx.png"), "rb") as agx, open(self.path("film.png"), "rb") as plain:
            self.assertNotEqual(agx.read(), plain.read())
        with self.assertRaisesRegex(glim.InputError, 'tone: "aces": expected none, neutral or agx'):
            film.save(self.path("none.png"), tone="aces")
        self.assertFalse(os.path.exists(self.path("none.png")))
        shown = film._repr_png_()
        self.assertEqual((shown[:4], shown[16:24]), (b"\x89PNG", (550).to_bytes(4, "big") + (5).to_bytes(4, "big")))
        self.assertIn("1100x10, 1 samples per pixel", repr(film))
        self.assertRegex(repr(glim.render(GEMS, size=(8, 8), spp=80)), r"estimated RMSE [0-9.]+ % of the mean \[")

    def test_pictures_without_the_background(self):
        options = {"size": (24, 20), "spp": 16, "environment": (1, 1, 1), "environment_background": False, "fov": 60}
        film = glim.render(GEMS, **options)
        film.save(self.path("film.exr"))
        subprocess.run([GLIM, "render", GEMS, "--size", "24x20", "--spp", "16", "--environment", "1,1,1", "--environment-background", "off",
                        "--fov", "60", "-o", self.path("cli.exr"), "--image", self.path("cli.png"), "--image", self.path("cli.webp")],
                       check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.assertEqual(film.digest, glim.read(self.path("cli.exr")).digest)
        self.assertLess(film.alpha.min(), film.alpha.max())
        for kind in ("png", "webp"):
            with open(self.path("cli." + kind), "rb") as file:
                expected = file.read()
            for saved in (film, glim.read(self.path("film.exr")), glim.merge([film])):
                saved.save(self.path("film." + kind))
                with open(self.path("film." + kind), "rb") as file:
                    self.assertEqual(file.read(), expected)
        self.assertEqual(film._repr_png_()[24:26], bytes((8, 6)), "8 bits, RGBA")

    def test_unknown_error(self):
        """Of a black picture and of radiance whose squares float32 does not hold: it meets no target, and ends the render."""
        with open(scene("light_point"), encoding="utf-8") as file:
            lamp = json.load(file)
        for intensity in (0, 1e25):
            lamp["extensions"]["KHR_lights_punctual"]["lights"][0]["intensity"] = intensity
            with open(self.path("lamp.gltf"), "w", encoding="utf-8") as file:
                json.dump(lamp, file)
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                film = glim.render(self.path("lamp.gltf"), size=(8, 8), target_rmse=10, denoise=True, environment="none")
            self.assertIn("the target is not reached after 1024 samples per pixel", str(caught[-1].message))
            self.assertIsNone(film.error)
            self.assertEqual(film.count.max(), 1024)
            self.assertNotRegex(repr(film), "nan|inf|\\[0")
            self.assertFalse(intensity == 0 and film.denoised_error)

    def test_denoised(self):
        plain, film = (glim.render(GEMS, size=(40, 32), spp=64, denoise=denoise) for denoise in (False, True))
        self.assertEqual(film.digest, plain.digest)
        self.assertIsNone(plain.denoised)
        self.assertIsNone(plain.denoised_error)
        self.assertEqual((film.denoised.shape, film.denoised.dtype), ((32, 40, 3), np.float32))
        self.assertFalse(np.array_equal(film.denoised, film.rgb))
        error = film.denoised_error
        self.assertLess(error.rmse_low, error.rmse)
        self.assertLess(error.rmse, error.rmse_high)
        self.assertLess(error.rel_mse, film.error.rel_mse)
        film.save(self.path("film.exr"))
        self.assertEqual(glim.read(self.path("film.exr")).digest, film.digest)
        subprocess.run([GLIM, "render", GEMS, "--size", "40x32", "--spp", "64", "--denoise", "-o", self.path("cli.exr"), "--png", self.path("cli.png")],
                       check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        film.save(self.path("film.png"))
        with open(self.path("film.png"), "rb") as mine, open(self.path("cli.png"), "rb") as other:
            self.assertEqual(mine.read(), other.read())
        more, whole = film.resume(spp=300), glim.render(GEMS, size=(40, 32), spp=300, denoise=True)
        self.assertEqual(more.digest, whole.digest)
        self.assertTrue(np.array_equal(more.denoised, whole.denoised))
        with self.assertRaisesRegex(glim.InputError, "not their two halves, which denoise needs"):
            plain.resume(spp=128, denoise=True)

    def test_resume(self):
        kept = glim.load(GEMS, size=(16, 12))
        for first, more in ((100, 300), (256, 300), (300, 900)):
            film = kept.render(spp=first)
            whole = kept.render(spp=more).digest
            self.assertEqual(film.resume(spp=more).digest, whole, first)
            film.save(self.path("film.exr"))
            if first % 256 == 0:
                self.assertEqual(kept.render(spp=more, resume=glim.read(self.path("film.exr"))).digest, whole)
        with self.assertRaisesRegex(glim.InputError, "its seed is 0, expected 1"):
            film.resume(spp=1000, seed=1)
        with self.assertRaisesRegex(glim.InputError, "not rendered here"):
            glim.read(self.path("film.exr")).resume(spp=1000)


class ArraysTest(PythonCase):
    def film(self, **options):
        return glim.render(GEMS, size=(24, 16), spp=64, ids=True, **options)

    def test_are_dense_copies_of_every_layer(self):
        film = self.film(denoise=True)
        arrays = film.arrays()
        self.assertEqual(sorted(arrays), ["K", "albedo", "alpha", "count", "denoised", "depth", "ids.material", "ids.mesh", "ids.node",
                                          "normal", "pose", "rgb", "variance"])
        for name, values in arrays.items():
            self.assertTrue(values.flags.c_contiguous and values.flags.owndata, name)
        for name in ("rgb", "alpha", "albedo", "normal", "depth", "count", "variance", "denoised"):
            np.testing.assert_array_equal(arrays[name], getattr(film, name), err_msg=name)
        np.testing.assert_array_equal(arrays["ids.node"], film.ids["node"])
        np.testing.assert_array_equal(arrays["pose"], film.camera.pose("gltf"))

    def test_are_saved_for_numpy(self):
        film = self.film()
        film.save(self.path("film.npz"))
        with np.load(self.path("film.npz"), allow_pickle=False) as saved:
            for name, values in film.arrays().items():
                np.testing.assert_array_equal(saved[name], values, err_msg=name)
        os.mkdir(self.path("folder.npz"))
        for name in ("folder.npz", "none/film.npz"):
            with self.assertRaises(glim.InputError) as refused:
                film.save(self.path(name))
            self.assertEqual(refused.exception.file, self.path(name))
        self.assertEqual(sorted(os.listdir(self.folder)), ["film.npz", "folder.npz"])

    def test_films_are_pickled(self):
        film = glim.render(GEMS, size=(24, 16), spp=40)
        copied = pickle.loads(pickle.dumps(film))
        self.assertEqual((copied.digest, copied.pixels_digest, copied.settings), (film.digest, film.pixels_digest, film.settings))
        np.testing.assert_array_equal(copied.variance, film.variance)
        whole = glim.load(GEMS, size=(24, 16)).render(spp=320, resume=pickle.loads(pickle.dumps(glim.render(GEMS, size=(24, 16), spp=256))))
        self.assertEqual(whole.pixels_digest, glim.render(GEMS, size=(24, 16), spp=320).pixels_digest)


class CameraTest(PythonCase):
    K = np.array([[40.0, 0, 15.5], [0, 42.0, 11.25], [0, 0, 1]])
    POSE = np.array([[0, 0, -1, 1.5], [0, -1, 0, 1.25], [-1, 0, 0, .5]])  # OpenCV's axes: looks along -x

    def test_of_numbers_is_that_of_the_options(self):
        camera = glim.Camera(self.K, origin="center", distortion=(-.2, .05, .001, 0), pose=self.POSE, axes="opencv", size=(32, 24))
        film = glim.render(GEMS, camera=camera, spp=4)
        told, _ = self.command_line(GEMS, "--size", "32x24", "--spp", "4", "--intrinsics", "40,42,16,11.75", "--distortion=-.2,.05,.001,0",
                                    "--pose-opencv=0,0,-1,1.5,0,-1,0,1.25,-1,0,0,.5")
        self.assertEqual(film.pixels_digest, told.pixels_digest)
        self.assertEqual(film.settings, told.settings)

    def test_comes_back_from_the_film_and_draws_the_same(self):
        camera = glim.Camera(self.K, origin="center", distortion=(-.2, .05, .001, 0), pose=self.POSE, axes="opencv", size=(32, 24))
        film = glim.render(GEMS, camera=camera, spp=4)
        film.save(self.path("a.exr"))
        for known in (film.camera, glim.read(self.path("a.exr")).camera):
            np.testing.assert_allclose(known.K("center"), self.K, rtol=1e-15)
            np.testing.assert_allclose(known.K("corner"), self.K + [[0, 0, .5], [0, 0, .5], [0, 0, 0]], rtol=1e-15)
            np.testing.assert_allclose(known.pose("opencv")[:3], self.POSE, atol=1e-7)
            self.assertEqual(known.distortion, [-.2, .05, .001, 0, 0, 0, 0, 0])
        again = glim.render(GEMS, camera=film.camera, size=(32, 24), spp=4)
        np.testing.assert_allclose(again.depth, film.depth, rtol=1e-5)
        self.assertIsNone(film.time)

    def test_of_the_file_has_a_K_and_a_pose(self):
        film = glim.render(GEMS, size=(32, 24), spp=1, **glim.look_at((0, 1, 4), (0, 1, 0)))
        np.testing.assert_allclose(film.camera.pose("gltf"), [[1, 0, 0, 0], [0, 1, 0, 1], [0, 0, 1, 4], [0, 0, 0, 1]], atol=1e-7)
        (fx, _, cx), (_, fy, cy), _ = film.camera.K("corner")
        self.assertEqual((fx, cx, cy), (fy, 16, 12))

    def test_sees_a_point_where_K_and_pose_say(self):
        film = glim.render(GEMS, camera=glim.Camera(self.K, origin="center", pose=self.POSE, axes="opencv", size=(32, 24)), spp=64)
        x, y = 9, 15  # a wall, so that a pixel's nearest depth and its middle's are close
        ray = np.linalg.inv(self.K) @ (x, y, 1) * film.depth[y, x]
        place = self.POSE[:, :3] @ ray + self.POSE[:, 3]
        self.assertAlmostEqual(place[0], -1, delta=.02)  # the red wall

    def test_may_be_round_or_all_around(self):
        fisheye = glim.render(GEMS, spp=1, camera=glim.Camera(self.K, origin="corner", fisheye=(0, 0, 0, 0), size=(32, 24)))
        self.assertEqual((fisheye.camera.fisheye, fisheye.width), ([0, 0, 0, 0], 32))
        around = glim.render(GEMS, spp=1, camera=glim.Camera(equirectangular=True), size=(64, 32))
        self.assertTrue(around.camera.equirectangular)
        self.assertIsNone(around.camera.K("corner"))

    def test_is_never_guessed(self):
        for arguments in ({"K": self.K}, {"pose": self.POSE}, {"K": self.K, "origin": "opencv"}, {"pose": self.POSE, "axes": "blender"},
                          {"K": np.eye(4), "origin": "corner"}, {"K": [[1, 1, 0], [0, 1, 0], [0, 0, 1]], "origin": "corner"},
                          {"distortion": (1, 2, 3)}, {"fisheye": "wide"}, {"pose": [1, 2, 3], "axes": "gltf"}):
            with self.assertRaises(glim.InputError, msg=arguments):
                glim.Camera(**arguments)
        with self.assertRaisesRegex(glim.InputError, "pose_gltf"):
            glim.render(GEMS, spp=1, camera=glim.Camera(pose=2 * self.POSE, axes="opencv"))


class UseTest(PythonCase):
    def test_edits(self):
        """scene.set and the option are one, and None takes a change back."""
        pointer, blue = "/materials/0/pbrMetallicRoughness/baseColorFactor", (0.1, 0.2, 0.9, 1)
        kept, options = glim.load(scene("textures"), size=(8, 8)), {"spp": 2}
        before = kept.render(**options).digest
        kept.set(pointer, blue)
        after = kept.render(**options).digest
        self.assertNotEqual(after, before)
        self.assertEqual(glim.render(kept.path, size=(8, 8), set={pointer: blue}, **options).digest, after)
        kept.set(pointer, None)
        self.assertEqual(kept.render(**options).digest, before)
        with self.assertRaisesRegex(glim.InputError, "is named \"nobody\""):
            glim.render(kept.path, set={"/materials/nobody/alphaCutoff": 1})
        with self.assertRaisesRegex(glim.InputError, "cannot use <object"):
            kept.set(pointer, object())
        self.assertEqual(kept.render(**options).digest, before)

    def test_caustics_are_decided_for_each_camera_and_scene(self):
        """Light paths find them where that has less noise: a session keeps the decision for one camera of one scene only."""
        def load():
            return glim.load(scene("cornell_gems"), size=(16, 16), spp=1)

        def hide(box):
            for name in ("diamond", "sapphire", "emerald"):
                box.nodes[name].visible = False
            return box
        box = load()
        for seed in (0, 1):
            for fov, is_off in ((60, False), (1, True)):
                film = box.render(seed=seed, fov=fov)
                self.assertEqual("caustics=off" in film.settings, is_off)
                self.assertEqual(film.digest, load().render(seed=seed, fov=fov).digest)
        film = hide(box).render(fov=1)
        self.assertNotIn("caustics=off", film.settings)
        self.assertEqual(film.digest, hide(load()).render(fov=1).digest)

    def test_guides_are_learned_for_each_camera_and_kind_of_caustics(self):
        """A session keeps its guide for pictures that learn the same one, and for no others."""
        def load():
            return glim.load(scene("cornell_mirror_glass"), size=(12, 12), spp=4, guiding=True)
        box, guides = load(), set()
        for options in ({"caustics": "off"}, {"caustics": "on"}, {"caustics": "on", "fov": 20}, {"caustics": "on", "fov": 20, "seed": 1}):
            film = box.render(**options)
            self.assertEqual(film.digest, load().render(**options).digest)
            guides.update(word for word in film.settings.split() if word.startswith("guide="))
        self.assertEqual(len(guides), 3)
        self.assertNotIn("guide=", box.render(guiding=False).settings)
        self.assertEqual(box.render(spp=100).resume(spp=300).digest, load().render(spp=300).digest)

    def test_have_ids_and_parts(self):
        def parts_of(step):
            with self.assertRaises((glim.InputError, glim.DeviceError)) as caught:
                step()
            error = caught.exception
            self.assertTrue(str(error))
            return error.id, error.file, error.place, error.value

        self.assertEqual(parts_of(lambda: glim.render(GEMS, spp=0)), ("out-of-range", None, "spp", "0"))
        self.assertEqual(parts_of(lambda: glim.render(GEMS, target_rmse="much")), ("malformed", None, "target_rmse", "much"))
        self.assertEqual(parts_of(lambda: glim.render(GEMS, no_option=1)), ("unknown-name", None, None, "no_option"))
        self.assertEqual(parts_of(lambda: glim.render(GEMS, spp=object)), ("wrong-type", None, "spp", "<class 'object'>"))
        self.assertEqual(parts_of(lambda: glim.render(GEMS, spp=1 << 2000))[:3], ("out-of-range", None, "spp"))
        missing = self.path("missing.glb")
        self.assertEqual(parts_of(lambda: glim.render(missing))[:3], ("file-missing", missing, None))
        film = glim.render(GEMS, size=(8, 8), spp=1)
        self.assertEqual(parts_of(lambda: film.save("x.gif"))[:2], ("unknown-format", "x.gif"))
        self.assertEqual(parts_of(lambda: film.save("x.png", tone="aces")), ("unknown-name", None, "tone", "aces"))
        self.assertEqual(parts_of(lambda: film.save("x.png", exposure=101)), ("out-of-range", None, "exposure", "101"))

    def test_warnings_have_ids(self):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            glim.render(scene("textures"), size=(8, 8), spp=1, environment="none")
        self.assertIn("no-light", [one.message.id for one in caught])

    def test_refusals(self):
        for options, words in (({"spp": 0}, "^spp: .*expected"), ({"sppp": 1}, "sppp"), ({"size": "8"}, "^size: "),
                               ({"image": "a.png"}, "^image: .*command line"), ({"time": object()}, "^time: "),
                               ({"target_rmse": .01, "spp": 4}, "^target_rmse: .*64")):
            with self.assertRaisesRegex(glim.InputError, words):
                glim.render(GEMS, **options)
        for name in ("help", "output", "Size"):
            with self.assertRaisesRegex(TypeError, name):
                glim.load(GEMS, **{name: True})
        self.assertTrue(issubclass(glim.InputError, ValueError) and issubclass(glim.DeviceError, RuntimeError))
        with self.assertRaisesRegex(glim.InputError, "missing.glb: cannot be"):
            glim.render(self.path("missing.glb"))
        with self.assertRaisesRegex(glim.InputError, "cannot be resumed|is not|not a film"):
            glim.read(GEMS)
        with self.assertRaisesRegex(glim.InputError, "no such device"):
            glim.render(GEMS, device="no such GPU")
        self.assertTrue(any(device["usable"] and device["memory"] > 0 for device in glim.devices()))

    def test_arguments_of_other_types(self):
        """One sentence of glim's own, that names the argument."""
        film = glim.render(GEMS, size=(8, 8), spp=1)
        for words, call in (("^films: cannot use 1, ", lambda: glim.merge([1])),
                            ("^films: cannot use <glim.Film", lambda: glim.merge(film)),
                            ("^films: cannot use 'ab', ", lambda: glim.merge("ab")), ("^path: cannot use 5, ", lambda: glim.read(5)),
                            ("^scene: cannot use None, ", lambda: glim.render(None)),
                            ("^resume: cannot use 5, ", lambda: glim.render(GEMS, resume=5)),
                            ("^progress: cannot use 5, ", lambda: glim.render(GEMS, progress=5)),
                            ("^bounces: .*true.*expected", lambda: glim.render(GEMS, bounces=True)),
                            ("^spp: cannot use 1000", lambda: glim.render(GEMS, spp=10**400)),
                            ("^size: cannot use True, ", lambda: glim.render(GEMS, size=(True, 8))),
                            ('camera "spp": expected one of', lambda: glim.render(GEMS, camera="--spp", spp=1)),
                            ("^origin: cannot use 5, ", lambda: glim.look_at(5, (0, 0, 0))),
                            ("^exposure: cannot use 'bright', ", lambda: film.save(self.path("a.png"), exposure="bright")),
                            ("^exposure: cannot use 1000000000.0, ", lambda: film.save(self.path("a.png"), exposure=1e9)),
                            ("^exposure: cannot use 1000", lambda: film.save(self.path("a.png"), exposure=10**400)),
                            ("^exposure: cannot use nan", lambda: film.save(self.path("a.png"), exposure=float("nan"))),
                            ("^tone: cannot use 5, ", lambda: film.save(self.path("a.png"), tone=5)),
                            ("^path: cannot use 5, ", lambda: film.save(5))):
            with self.assertRaisesRegex(glim.InputError, words):
                call()
        self.assertEqual(os.listdir(self.folder), [])

    def test_names_of_files(self):
        """None is cut at a null character, bytes are names too, and an ending that is unknown is refused."""
        film = glim.render(os.fsencode(GEMS), size=(8, 8), spp=1)
        film.save(os.fsencode(self.path("film.EXR")))
        self.assertEqual(glim.read(os.fsencode(self.path("film.EXR"))).digest, film.digest)
        for call in (lambda name: glim.read(name), lambda name: glim.load(name), lambda name: film.save(name),
                     lambda name: glim.render(GEMS, environment=name)):
            with self.assertRaisesRegex(glim.InputError, "has a null character"):
                call(self.path("film.EXR") + "\0.exr")
        for name in ("film.npy", "film.bmp", "film", "film.exr.tif", "exr"):
            with self.assertRaisesRegex(glim.InputError, "its name does not end in .exr, .npz, .png, .jpg, .jpeg or .webp"):
                film.save(self.path(name))
        odd = os.fsdecode(os.fsencode(self.folder) + b"/\xff.gltf")  # no Unicode
        shutil.copy(scene("cornell"), odd)
        self.assertEqual(glim.render(odd, size=(8, 8), spp=1).width, 8)
        self.assertEqual(sorted(os.listdir(self.folder)), ["film.EXR", os.path.basename(odd)])

    def test_warnings(self):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            glim.render(scene("cornell"), size=(8, 8), spp=1, environment="none")
            self.assertEqual(caught, [])
            glim.render(GEMS, size=(8, 8), spp=64, clamp_indirect=.1)
        self.assertEqual([(one.category, one.filename) for one in caught], [(glim.GlimWarning, __file__)])
        self.assertIn("clamp_indirect removed", str(caught[0].message))

    def test_progress(self):
        calls = []
        film = glim.render(GEMS, size=(64, 64), spp=64, progress=lambda *call: calls.append(call))
        self.assertEqual(calls, sorted(calls))
        self.assertEqual(calls[-1][:2], (64 * 64 * 64, 64 * 64 * 64))

        def nested(_done, _total, _seconds):
            film.save(self.path("film.exr"))
            glim.render(GEMS, size=(8, 8), spp=1)
        with self.assertRaisesRegex(RuntimeError, "`progress` cannot render"):
            glim.render(GEMS, size=(64, 64), spp=64, progress=nested)

        def stop(done, total, seconds):
            if done > 0:
                raise KeyError("enough")
        with self.assertRaises(KeyError) as caught:
            glim.render(GEMS, size=(64, 64), spp=100000, progress=stop)
        stopped = caught.exception.film
        self.assertLess(stopped.samples[-1][1], 100000)
        self.assertGreater(stopped.count.sum(), 0)
        self.assertEqual(film.digest, glim.render(GEMS, size=(64, 64), spp=64).digest)

    def test_interrupts(self):
        """Ctrl-C at 20 moments of a render: the film so far is kept, and goes on to the bits of a render without an interruption."""
        kept = glim.load(GEMS, size=(24, 24), seed=5)
        kept.render(spp=1)  # with this, the kernels are compiled
        begin = time.monotonic()
        whole = kept.render(spp=640)
        seconds, stopped = time.monotonic() - begin, 0
        for moment in range(1, 21):
            timer = threading.Timer(seconds * moment / 20, os.kill, (os.getpid(), signal.SIGINT))
            film = None
            try:
                timer.start()
                film = kept.render(spp=640)
                timer.join()
                time.sleep(.01)  # for an interrupt that comes last
            except KeyboardInterrupt as interrupt:
                if film is None:
                    film = interrupt.film
                    self.assertEqual(film and film.digest, kept.last_film and kept.last_film.digest)
                    stopped += film is None or film.digest != whole.digest
            timer.join()
            if film is not None:
                self.assertGreater(film.count.sum(), 0)
                self.assertEqual(kept.render(spp=640, resume=film).digest, whole.digest, moment)
        self.assertGreater(stopped, 5)  # about 19; fewer if other work made the first render slow

    def test_threads(self):
        expected = [glim.render(GEMS, size=(32, 32), spp=64, seed=seed).digest for seed in (1, 2)]
        digests, ticks = {}, 0

        def render(seed):
            kept = glim.load(GEMS, size=(32, 32), seed=seed)
            digests[seed] = {kept.render(spp=64).digest for _ in range(5)}
        threads = [threading.Thread(target=render, args=(seed,)) for seed in (1, 2)]
        for thread in threads:
            thread.start()
        while any(thread.is_alive() for thread in threads):
            ticks += 1
            time.sleep(.001)
        self.assertEqual([digests[seed] for seed in (1, 2)], [{digest} for digest in expected])
        self.assertGreater(ticks, 50)  # Python went on meanwhile

    def test_memory_stays(self):
        """Without the validation layer, which keeps 50 KB of each render to itself."""
        grown = run_python("""
import glim
kept = glim.load(%r, size=(16, 16), spp=1, caustics="on")  # without the pass that decides

def bytes_after(renders):  # those that no file holds: a library's count as private or shared by what other processes run
    for seed in range(renders):
        kept.render(seed=seed, size=(16 + seed %% 2, 16)).variance
    with open("/proc/self/smaps_rollup", encoding="ascii") as rollup:
        return next(int(line.split()[1]) << 10 for line in rollup if line.startswith("Anonymous:"))

before = bytes_after(200)
print(bytes_after(1000) - before)
""" % GEMS, GLIM_VALIDATION="0")
        self.assertLess(int(grown), 4 << 20)

    def test_scene_goes_with_its_last_reference(self):
        """At once, and not when garbage is collected: it holds a device."""
        kept = glim.load(GEMS, size=(8, 8), spp=1)
        film, gone = kept.render(), weakref.ref(kept)
        del kept
        self.assertIsNotNone(gone())  # film.resume() needs it
        del film
        self.assertIsNone(gone())

    def test_fork(self):
        said = run_python("""
import os, glim
glim.render(%r, size=(8, 8), spp=1)
if os.fork() == 0:
    try:
        glim.render(%r, size=(8, 8), spp=1)
    except glim.DeviceError as error:
        print(error, flush=True)
    os._exit(0)
os.wait()
""" % (GEMS, GEMS))
        self.assertIn("Vulkan does not survive", said)
        # A process that has not used it may fork.
        said = run_python("""
import os, glim
if os.fork() == 0:
    print(glim.render(%r, size=(8, 8), spp=1).complete, flush=True)
    os._exit(0)
os.wait()
""" % GEMS)
        self.assertEqual(said, "True\n")

    def test_without_vulkan(self):
        code = """
import glim
try:
    glim.render(%r)
except glim.DeviceError as error:
    print(error)
""" % GEMS
        with open(self.path("libvulkan.so.1"), "w", encoding="ascii") as file:
            file.write("no library")
        self.assertIn("libvulkan1 mesa-vulkan-drivers", run_python(code, LD_LIBRARY_PATH=self.folder))
        self.assertIn("mesa-vulkan-drivers", run_python(code, VK_DRIVER_FILES=self.path("none"), VK_ICD_FILENAMES=self.path("none")))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
