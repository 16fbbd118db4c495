"""What tools/to_gltf does."""

import argparse
import os
import sys

sys.dont_write_bytecode = True  # beside the sources it would look like a change to build
sys.path[0] = os.path.dirname(os.path.dirname(os.path.realpath(__file__)))

from conversion.errors import ConversionError  # noqa: E402

DESCRIPTION = """Converts OBJ and PLY to glTF, for glim and others.

Of OBJ it keeps texture coordinates, normals, smoothing groups, vertex colours, and of its materials Kd, d, Tr, Ns, Pr, Pm, Ke, map_Kd and
map_Ke. PLY is read by trimesh, which the first call installs from PyPI into a Python environment of its own (build/to_gltf). Normals and
colours are kept. Colours of vertices count as sRGB. Polygons of both may be concave. Surfaces get both sides, since neither format has
single-sided ones. Lengths stay what they are: glTF takes them for metres, and y for up."""


def parse_arguments():
    parser = argparse.ArgumentParser(prog="to_gltf", description=DESCRIPTION, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("model", metavar="MODEL", help="what to convert: .obj or .ply")
    parser.add_argument("-o", "--output", metavar="FILE", required=True, help="where to write: .glb or .gltf")
    arguments = parser.parse_args()
    if not arguments.output.endswith((".glb", ".gltf")):
        parser.error("-o %s: expected a name that ends in .glb or .gltf" % arguments.output)
    if not arguments.model.lower().endswith((".obj", ".ply")):
        parser.error("%s: expected a name that ends in .obj or .ply" % arguments.model)
    return arguments


def convert(path):
    if path.lower().endswith(".obj"):
        from conversion.obj_to_gltf import obj_to_gltf
        return obj_to_gltf(path, say)
    from conversion.environment import Environment
    Environment("to_gltf", ["trimesh==5.2.0", "numpy"]).enter(say)
    from conversion.ply_to_gltf import ply_to_gltf
    return ply_to_gltf(path, say)


def say(text):
    print("to_gltf: %s" % text, file=sys.stderr, flush=True)


def main():
    arguments = parse_arguments()
    try:
        if not os.path.isfile(arguments.model):
            raise ConversionError("%s: there is no such file" % arguments.model)
        convert(arguments.model).write(arguments.output)
    except (ConversionError, OSError) as error:
        sys.exit("to_gltf: %s" % error)
    except KeyboardInterrupt:
        sys.exit(130)


if __name__ == "__main__":
    main()
