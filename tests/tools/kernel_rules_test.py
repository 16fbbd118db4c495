"""Two rules of shaders/README.md that no compiler knows, looked for in the SPIR-V of the kernels.

Usage: kernel_rules_test.py FOLDER_OF_SPIRV
"""
import re
import subprocess
import sys
import tempfile
import unittest
from collections import defaultdict
from pathlib import Path

SHADERS = Path(__file__).resolve().parents[2] / "shaders"
TEXELS_OF = int(re.search(r"kTexelsOf = (\d+)u", (SHADERS / "shared/bindings.h").read_text()).group(1))
INLINE = ["--merge-return", "--inline-entry-points-exhaustive", "--eliminate-dead-functions"]
# Each value has one definition, and variables that calls do not see are gone.
PROMOTE = ["--merge-return", "--scalar-replacement=0", "--ssa-rewrite", "--ccp", "--eliminate-dead-branches", "--eliminate-dead-code-aggressive"]
# Values that leave a loop without being carried, by function. Pictures with them are the same on drivers with and without that bug: a lane computes them
# again from what stays as it was in its last iteration.
ESCAPING = {"traceThroughAlpha": 4, "traceLightThroughAlpha": 1, "findEntry": 1, "chooseCausticLight": 1, "chooseInfiniteLight": 1, "evalInterface": 1}


class Function:
    def __init__(self, name):
        self.name = name
        self.blocks = {}  # by label: [(result, operation, operands)]
        self.successors = defaultdict(list)
        self.loops = {}  # header: the block behind the loop

    def body(self, header):
        """The blocks of a loop."""
        found, todo = set(), [header]
        while todo:
            block = todo.pop()
            if block not in found and block != self.loops[header]:
                found.add(block)
                todo += self.successors[block]
        return found

    def reaches(self, block):
        """The blocks that may follow it within an iteration of the loops around it."""
        found, todo = set(), [block]
        while todo:
            here = todo.pop()
            ahead = [b for b in self.successors[here] if not (b in self.loops and here in self.body(b))]
            todo += [b for b in ahead if b not in found]
            found.update(ahead)
        return found


class Module:
    def __init__(self, path, passes):
        with tempfile.TemporaryDirectory() as scratch:
            out = str(Path(scratch) / "out.spv")
            subprocess.run(["spirv-opt", "--target-env=vulkan1.2", "--scalar-block-layout", *passes, str(path), "-o", out], check=True,
                           stderr=subprocess.DEVNULL)  # it says which calls it cannot inline, and inlines them with merged returns
            self.text = subprocess.run(["spirv-dis", "--raw-id", "--no-color", out], check=True, capture_output=True, text=True).stdout
        names = dict(re.findall(r'OpName (%\d+) "(\w+)', self.text))
        self.binding = {name: int(number) for name, number in re.findall(r"OpDecorate (%\d+) Binding (\d+)", self.text)}
        self.functions = []
        for result, operation, rest in re.findall(r"^ *(?:(%\d+) = )?(Op\w+)(.*)", self.text, re.M):
            ids = re.findall(r"%\d+", rest)
            if operation == "OpFunction":
                self.functions.append(Function(names.get(result, result)))
            elif operation == "OpLabel":
                block = result
                self.functions[-1].blocks[block] = []
            elif self.functions and self.functions[-1].blocks:
                function = self.functions[-1]
                function.blocks[block].append((result, operation, ids[1:] if result else ids))
                if operation == "OpLoopMerge":
                    function.loops[block] = ids[0]
                elif operation in ("OpBranch", "OpBranchConditional", "OpSwitch"):
                    function.successors[block] = ids[0 if operation == "OpBranch" else 1:]


def escaping(function):
    """Values that a loop tested at its end computes anew each time, and that the code behind the loop uses."""
    defined, uses = {}, defaultdict(set)
    for block, instructions in function.blocks.items():
        for result, operation, operands in instructions:
            defined[result] = block
            if operation == "OpPhi":
                for value, origin in zip(operands[::2], operands[1::2]):
                    uses[value].add(origin)
            else:
                for value in operands:
                    uses[value].add(block)
    found = set()
    for header, behind in function.loops.items():
        body = function.body(header)
        if not any(header in function.successors[b] and behind in function.successors[b] for b in body):
            continue
        carried = {value for result, operation, operands in function.blocks[header] if operation == "OpPhi" for value in (result, *operands)}
        found |= {value for value, block in defined.items() if value and block in body and value not in carried and uses[value] - body}
    return found


def read_after_write(module, function):
    """Bindings that are read as texels behind a store to the buffer, within the work on one path."""
    of, reads, writes = {}, [], []
    for block, instructions in function.blocks.items():
        for at, (result, operation, operands) in enumerate(instructions):
            of[result] = of.get(operands[0], module.binding.get(operands[0])) if operands else None
            if operation == "OpImageFetch":
                reads.append((of[result], block, at))
            elif operation == "OpStore":
                writes.append((of.get(operands[0]), block, at))
    return {written for written, block, at in writes for read, where, when in reads
            if written is not None and read == written + TEXELS_OF and (where in function.reaches(block) or (where == block and when > at))}


class KernelRules(unittest.TestCase):
    folder = Path()

    def modules(self, passes):
        kernels = sorted(self.folder.glob("*.spv"))
        self.assertGreater(len(kernels), 20)
        return [(kernel.stem, Module(kernel, passes)) for kernel in kernels]

    def compile(self, text):
        """A kernel of these lines, with a buffer of uints at binding 7, its texels, and a function f that has a loop."""
        with tempfile.TemporaryDirectory() as scratch:
            source, out = Path(scratch) / "kernel.comp", Path(scratch) / "kernel.spv"
            source.write_text("#version 460\nlayout(binding = 7) buffer B { uint words[]; };\nlayout(binding = %d) uniform usamplerBuffer texels;\n%s" %
                              (7 + TEXELS_OF, text))
            subprocess.run(["glslangValidator", "--quiet", "-V", "--target-env", "vulkan1.2", "-o", str(out), str(source)], check=True)
            return Module(out, INLINE), Module(out, PROMOTE)

    def test_texels_of_a_path_are_read_before_its_buffer_is_written(self):
        for kernel, module in self.modules(INLINE):
            for function in module.functions:
                self.assertEqual(read_after_write(module, function), set(), kernel)

    def test_code_behind_a_loop_uses_what_the_loop_carries(self):
        for kernel, module in self.modules(PROMOTE):
            for function in module.functions:
                found = escaping(function)
                self.assertLessEqual(len(found), ESCAPING.get(function.name, 0), f"{function.name} in {kernel}: {found}")

    def test_a_second_read_is_found(self):
        fetch, store = "uint x = texelFetch(texels, 3).x;", "words[3] = 5u;"
        for body, expected in ((fetch + store + "words[4] = x;", set()), (store + fetch + "words[4] = x;", {7}),
                               ("for (uint i = 0u; i < words[0]; ++i) { %s words[i] = x; }" % fetch, set()),
                               ("for (uint i = 0u; i < words[0]; ++i) { words[i] = 1u; if (i > 3u) { %s words[8] = x; } }" % fetch, {7})):
            module, _ = self.compile("void f() { %s }\nvoid main() { f(); }" % body)
            self.assertEqual(set().union(*(read_after_write(module, function) for function in module.functions)), expected, body)

    def test_a_value_that_leaves_a_loop_is_found(self):
        loop = "uint f() { uint i = words[0], sum = 0u, last; do { last = words[i]; sum += last; ++i; } while (i < words[1]); return %s; }"
        for result, expected in (("sum", 0), ("i", 0), ("last", 1)):
            _, module = self.compile(loop % result + "\nvoid main() { words[2] = f(); }")
            self.assertEqual(sum(len(escaping(function)) for function in module.functions), expected, result)


if __name__ == "__main__":
    KernelRules.folder = Path(sys.argv.pop())
    unittest.main()
