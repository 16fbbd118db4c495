#include "host/spirv/exact.hpp"

#include "host/spirv/builder.hpp"
#include "host/spirv/import.hpp"

namespace glim::spirv {

void makeExact(Module& module, const Module& library)
{
    Importer importer(module, library);
    std::vector<Instruction> out;
    Builder build(module, out);
    for (Instruction& i : module.functions) {
        if (i.opcode() == kOpFDiv) {
            build.callByComponent(importer.function("exactQuotient"), i.type, {i.words[3], i.words[4]}, i.result);
        } else if (i.isExtended(kGlslSqrt)) {
            build.callByComponent(importer.function("exactRoot"), i.type, {i.words[5]}, i.result);
        } else {
            out.push_back(std::move(i));
        }
    }
    const std::vector<Instruction> imported = importer.takeFunctions();
    out.insert(out.end(), imported.begin(), imported.end());
    module.functions = std::move(out);
}

}  // namespace glim::spirv
