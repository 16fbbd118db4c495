#include "host/spirv/interface.hpp"

#include <algorithm>
#include <cstring>

namespace glim::spirv {
namespace {

enum StorageClass : std::uint32_t { kUniformConstant = 0, kUniform = 2, kPushConstant = 9, kStorageBuffer = 12 };
enum Decoration : std::uint32_t {
    kSpecId = 1,
    kRowMajor = 4,
    kColMajor = 5,
    kArrayStride = 6,
    kMatrixStride = 7,
    kBuiltIn = 11,
    kBinding = 33,
    kDescriptorSet = 34,
    kOffset = 35
};
constexpr std::uint32_t kWorkgroupSize = 25;  // a built-in constant

class Reader {
public:
    explicit Reader(const Module& module)
        : module_(module)
    {
        for (const Instruction& instruction : module.preamble()) {
            const Words& words = instruction.words;
            if (instruction.opcode() == kOpCapability) {
                capabilities_.insert(words[1]);
            } else if (instruction.opcode() == kOpName) {
                names_[words[1]] = reinterpret_cast<const char*>(&words[2]);
            } else if (instruction.opcode() == kOpDecorate) {
                decorations_[words[1]][words[2]] = words.size() > 3 ? words[3] : 0;
            } else if (instruction.opcode() == kOpMemberDecorate) {
                members_[words[1]][words[2]][words[3]] = words.size() > 4 ? words[4] : 0;
            }
        }
    }

    Interface read() const
    {
        Interface interface;
        interface.capabilities = capabilities_;
        for (const Instruction& global : module_.globals()) {
            if (global.opcode() == kOpVariable) {
                add(interface, global);
            }
        }
        for (const auto& [id, decorations] : decorations_) {
            if (const auto builtIn = decorations.find(kBuiltIn); builtIn != decorations.end() && builtIn->second == kWorkgroupSize) {
                interface.workgroup = describe(id);
            }
        }
        return interface;
    }

private:
    using Decorations = std::map<std::uint32_t, std::uint32_t>;  // with their first operands

    void add(Interface& interface, const Instruction& variable) const
    {
        const std::uint32_t storage = variable.words[3];
        if (storage == kPushConstant) {
            interface.pushConstants.insert(describe(variable.type));
        } else if (storage == kUniformConstant || storage == kUniform || storage == kStorageBuffer) {
            const Decorations& placed = decorations_.at(variable.result);
            interface.bindings[placed.at(kBinding)].insert(std::to_string(placed.at(kDescriptorSet)) + ": " + describe(variable.type));
            interface.names[placed.at(kBinding)] = nameOf(variable);
        }
    }

    // A block without a name of its own has that of its type.
    std::string nameOf(const Instruction& variable) const
    {
        const auto own = names_.find(variable.result);
        if (own != names_.end() && !own->second.empty()) {
            return own->second;
        }
        const auto block = names_.find(module_.global(variable.type).words[3]);
        return block == names_.end() ? "" : block->second;
    }

    // The instruction with all that it names in place of their ids.
    std::string describe(Id id) const
    {
        const Instruction& global = module_.global(id);
        std::string text = "(" + std::to_string(global.opcode());
        for (std::uint16_t i = 1; i < global.words.size(); ++i) {
            if (i != (global.type == 0 ? 1 : 2)) {
                const bool isId = std::ranges::find(global.idAt, i) != global.idAt.end();
                text += " " + (isId ? describe(global.words[i]) : std::to_string(global.words[i]));
            }
        }
        if (const auto found = decorations_.find(id); found != decorations_.end()) {
            text += describe(found->second);
        }
        if (const auto found = members_.find(id); found != members_.end()) {
            for (const auto& [member, decorations] : found->second) {
                text += " member" + describe(decorations);
            }
        }
        return text + ")";
    }

    static std::string describe(const Decorations& decorations)
    {
        std::string text;
        for (const auto& [decoration, operand] : decorations) {
            switch (decoration) {
            case kSpecId:
            case kRowMajor:
            case kColMajor:
            case kArrayStride:
            case kMatrixStride:
            case kOffset: text += " " + std::to_string(decoration) + "=" + std::to_string(operand); break;
            default: break;
            }
        }
        return text;
    }

    const Module& module_;
    std::set<std::uint32_t> capabilities_;
    std::map<Id, std::string> names_;
    std::map<Id, Decorations> decorations_;
    std::map<Id, std::map<std::uint32_t, Decorations>> members_;
};

}  // namespace

Interface readInterface(const Module& module) { return Reader(module).read(); }

std::string findMisfit(const Interface& kernel, const Interface& host)
{
    for (const auto& [binding, types] : kernel.bindings) {
        const std::string name = "binding " + std::to_string(binding) + " (" + kernel.names.at(binding) + ")";
        const auto bound = host.bindings.find(binding);
        if (bound == host.bindings.end()) {
            return name + " is unknown to the host";
        }
        if (!std::ranges::includes(bound->second, types)) {
            return name + " has another layout than in the host";
        }
    }
    if (!std::ranges::includes(host.pushConstants, kernel.pushConstants)) {
        return "its push constants have another layout than in the host";
    }
    for (const std::uint32_t capability : kernel.capabilities) {
        if (!host.capabilities.contains(capability)) {
            return "SPIR-V's capability " + std::to_string(capability) + " is none that the host asks a device for";
        }
    }
    return kernel.workgroup == host.workgroup ? "" : "its workgroups have another size than in the host";
}

}  // namespace glim::spirv
