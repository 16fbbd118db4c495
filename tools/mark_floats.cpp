// mark_floats IN.spv OUT.spv: makes the results of float arithmetic unique (host/spirv/mark.hpp).
#include "host/spirv/mark.hpp"

#include <cstdio>
#include <exception>
#include <fstream>
#include <iterator>
#include <string>

namespace {

using namespace glim::spirv;

Words readWords(const char* path)
{
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    Words words(bytes.size() / 4);
    bytes.copy(reinterpret_cast<char*>(words.data()), words.size() * 4);
    return words;
}

}  // namespace

int main(int argc, char** argv)
{
    if (argc != 3) {
        std::fprintf(stderr, "usage: mark_floats IN.spv OUT.spv\n");
        return 2;
    }
    try {
        Module module(readWords(argv[1]));
        markFloats(module);
        const Words words = module.assemble();
        std::ofstream out(argv[2], std::ios::binary);
        out.write(reinterpret_cast<const char*>(words.data()), static_cast<std::streamsize>(words.size() * sizeof(words[0])));
        return out.flush().good() ? 0 : 1;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s: %s\n", argv[1], error.what());
        return 1;
    }
}
