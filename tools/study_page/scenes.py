"""The scenes of the study: the course's own where they are present, otherwise ours of the same kind."""

import os

from scene_makers.study_scenes import blob_in_room, bright_furnace, lone_blob

from .arguments import ROOT
from .errors import StudyError

# By role: the course's file; our committed file; or how to make a mesh, with its triangles. The beast lies in scans/ beside seed/.
COURSE = {"spheres": "CBspheres_lambertian.glb", "gems": "CBgems.glb", "cow": "cow.glb", "beast": "beast.glb",
          "bunny": "CBbunny.glb"}
COMMITTED = {"spheres": "cornell_spheres.gltf", "gems": "cornell_gems.gltf"}
MADE = {"cow": (lone_blob, 5856), "beast": (lone_blob, 64618), "bunny": (blob_in_room, 28588)}
COURSE_NAMES = {"spheres": "two spheres", "gems": "three gems", "cow": "cow", "beast": "beast", "bunny": "bunny"}
OUR_NAMES = {"spheres": "two spheres", "gems": "three gems", "cow": "small blob", "beast": "large blob",
             "bunny": "blob in a box"}


class Scenes:
    def __init__(self, course_folder, made_folder):
        self.made = made_folder
        found = {role: find_course_scene(course_folder, file) for role, file in COURSE.items()}
        self.is_course = all(found.values())
        if not self.is_course and any(found.values()):
            missing = sorted(COURSE[role] for role, path in found.items() if path is None)
            raise StudyError("%s has only some of the course's scenes; missing: %s" % (course_folder, ", ".join(missing)))
        os.makedirs(made_folder, exist_ok=True)
        self.paths = found if self.is_course else {role: self.own(role) for role in COURSE}
        self.paths["furnace"] = self.make("furnace.glb", bright_furnace())

    @property
    def names(self):
        return COURSE_NAMES if self.is_course else OUR_NAMES

    def make(self, name, document):
        path = os.path.join(self.made, name)
        document.write(path)
        return path

    def own(self, role):
        if role in COMMITTED:
            return os.path.join(ROOT, "scenes", COMMITTED[role])
        maker, triangles = MADE[role]
        return self.make(role + ".glb", maker(triangles))

    def blob(self, triangles):
        """The role of a mesh of about as many triangles, made on demand."""
        role = "blob%d" % triangles
        if role not in self.paths:
            self.paths[role] = self.make(role + ".glb", lone_blob(triangles))
        return role

    def path(self, role):
        return self.paths[role]

    def files(self):
        return {role: os.path.basename(path) for role, path in self.paths.items()}


def find_course_scene(folder, file):
    for place in (folder, os.path.join(os.path.dirname(os.path.normpath(folder)), "scans")):
        path = os.path.join(place, file)
        if os.path.isfile(path):
            return path
    return None
