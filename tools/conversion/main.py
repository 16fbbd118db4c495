"""What tools/to_gltf does."""

import argparse
import os
import sys

sys.dont_write_bytecode = True  # beside the sources it would look like a change to build
sys.path[0] = os.path.dirname(os.path.dirname(os.path.realpath(__file__)))

from conversion.environment import Environment  # noqa: E402
from conversion.errors import ConversionError, as_line  # noqa: E402

ENVIRONMENT = Environment("to_gltf", ["trimesh==5.2.0", "pycollada==0.9.3", "numpy"])

DESCRIPTION = """Converts OBJ, PLY and Collada (.dae) to glTF, for glim and others.

Of OBJ it keeps texture coordinates, normals, smoothing groups, vertex colours, and of its materials Kd, d, Tr, Ns, Pr, Pm, Ke, map_Kd and
map_Ke. PLY is read by trimesh, Collada by pycollada: the first call installs both from PyPI into a Python environment of their own
(build/to_gltf). Of PLY it keeps normals and colours; a file without faces becomes points. Colours of vertices count as sRGB. Polygons may
be concave. Surfaces get both sides, since none of the formats has single-sided ones. Lengths of OBJ and PLY stay what they are: glTF takes
them for metres, and y for up.

Of Collada it keeps meshes, nodes and their instances, the up axis, the unit, cameras, point, spot, directional and ambient lights, and of
materials the diffuse colour or texture, emission and transparency. Ambient light becomes a map beside the output. Lights fall with the
square of the distance; those that do not in the file are as bright in the middle of the scene.

Scenes of the courses CS 184 (Berkeley) and 15-462 (CMU) have more in <technique profile="CGL"> or "CMU462": the materials emission, mirror,
glass, refraction and microfacet (alpha, eta, k), spheres, and area lights, which become squares. These and surfaces with emission shine
from the front. A file that has any of it is read as the course's programs read it: camera 0 is their opening view, before the file's own;
meshes are smooth, whatever their normals; z turns up by half a turn more about y; point lights have no attenuation; suns shine from where
those programs put them; and ambient light is a sky above the horizon. The programs do not show that sky, which glim render
--environment-background off hides."""


def parse_arguments():
    parser = argparse.ArgumentParser(prog="to_gltf", description=DESCRIPTION, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("model", metavar="MODEL", help="what to convert: .obj, .ply or .dae")
    parser.add_argument("-o", "--output", metavar="FILE", required=True, help="where to write: .glb or .gltf")
    parser.add_argument("--course", action="store_true", help="read Collada as the courses' programs do, also without their profile")
    arguments = parser.parse_args()
    if not arguments.output.endswith((".glb", ".gltf")):
        parser.error("-o %s: expected a name that ends in .glb or .gltf" % arguments.output)
    if not arguments.model.lower().endswith((".obj", ".ply", ".dae")):
        parser.error("%s: expected a name that ends in .obj, .ply or .dae" % arguments.model)
    if arguments.course and not arguments.model.lower().endswith(".dae"):
        parser.error("--course: expected a model that ends in .dae")
    return arguments


def convert(path, course):
    if path.lower().endswith(".obj"):
        from conversion.obj_to_gltf import obj_to_gltf
        return obj_to_gltf(path, say)
    ENVIRONMENT.enter(say)
    if path.lower().endswith(".dae"):
        from conversion.collada_to_gltf import collada_to_gltf
        return collada_to_gltf(path, course, say)
    from conversion.ply_to_gltf import ply_to_gltf
    return ply_to_gltf(path, say)


def say(text):
    print("to_gltf: %s" % as_line(text), file=sys.stderr, flush=True)


def main():
    arguments = parse_arguments()
    try:
        if not os.path.isfile(arguments.model):
            raise ConversionError("%s: there is no such file" % arguments.model)
        convert(arguments.model, arguments.course).write(arguments.output)
    except (ConversionError, OSError) as error:
        sys.exit("to_gltf: %s" % as_line(str(error)))
    except KeyboardInterrupt:
        sys.exit(130)


if __name__ == "__main__":
    main()
