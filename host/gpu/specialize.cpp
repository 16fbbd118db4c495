#include "host/gpu/specialize.hpp"

#include "host/digest.hpp"
#include "host/gpu/cache_file.hpp"
#include "host/gpu/device.hpp"
#include "host/gpu/replaced_kernels.hpp"
#include "host/text.hpp"
#include "specializer.h"

#include <spirv-tools/libspirv.h>
#include <spirv-tools/optimizer.hpp>

#include <cstring>
#include <mutex>

namespace glim {
namespace {

// About ten scenes' kernels, some 10 MiB: a process that serves for weeks keeps no more.
constexpr std::size_t kMaxKept = 64;

// Drivers do set constants themselves, but may translate the whole kernel and inline every call before they drop what they make
// unreachable: that took .9 s for trace_paths (shaders/driver_bugs.md). No pass here changes arithmetic: SPIRV-Tools folds no operation
// that is NoContraction.
std::vector<std::uint32_t> optimize(const EmbeddedShader& shader, const Specialization& specialization)
{
    std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> values;
    for (const auto& [id, value] : specialization) {
        values[id] = {value};
    }
    std::string message;
    spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_2);
    optimizer.SetMessageConsumer([&message](spv_message_level_t, const char*, const spv_position_t&, const char* text) { message = text; });
    optimizer.RegisterPass(spvtools::CreateStripDebugInfoPass());
    optimizer.RegisterPass(spvtools::CreateSetSpecConstantDefaultValuePass(values));
    optimizer.RegisterPass(spvtools::CreateFreezeSpecConstantValuePass());
    optimizer.RegisterPass(spvtools::CreateFoldSpecConstantOpAndCompositePass());
    optimizer.RegisterPass(spvtools::CreateCCPPass());
    optimizer.RegisterPass(spvtools::CreateDeadBranchElimPass());
    optimizer.RegisterPass(spvtools::CreateEliminateDeadFunctionsPass());
    spvtools::OptimizerOptions options;
    options.set_run_validator(false);  // the build has validated it
    std::vector<std::uint32_t> specialized;
    if (!optimizer.Run(shader.begin, shader.words().size(), &specialized, options)) {
        throw DeviceError(MessageId::LibraryFailed,
                          {"Kernel ", part::place(shader.name), " cannot be specialized: ", part::value(message)});
    }
    return specialized;
}

std::vector<std::uint32_t> make(const EmbeddedShader& shader, const Specialization& specialization, const Arithmetic& arithmetic)
{
    return computeBy(arithmetic, optimize(shader, specialization));
}

// All that the result depends on.
std::string keyOf(const EmbeddedShader& shader, const Specialization& specialization, const Arithmetic& arithmetic)
{
    Digest digest;
    digest.add(std::as_bytes(shader.words()));
    std::string key = std::string("SPIR-V of ") + shader.name + ' ' + digest.finish() + " by " GLIM_SPECIALIZER " and " +
                      spvSoftwareVersionDetailsString() + (arithmetic.exact ? ", exact" : "") +
                      (arithmetic.declaresRounding ? ", rounding" : "");
    for (const auto& [id, value] : specialization) {
        key += format(", %u = %u", id, value);
    }
    return key;
}

// .05 s of CPU a kernel, which the next run need not take.
std::vector<std::uint32_t> readOrMake(const EmbeddedShader& shader, const Specialization& specialization, const Arithmetic& arithmetic)
{
    if (arithmetic.adverse) {  // its seeds would fill the disk
        return make(shader, specialization, arithmetic);
    }
    CacheFile file(keyOf(shader, specialization, arithmetic), ".spirv");
    const std::string kept = file.read();
    std::vector<std::uint32_t> words(kept.size() / sizeof(std::uint32_t));
    std::memcpy(words.data(), kept.data(), words.size() * sizeof(std::uint32_t));
    if (words.empty()) {
        words = make(shader, specialization, arithmetic);
        if (file.isKept()) {
            file.write({reinterpret_cast<const char*>(words.data()), words.size() * sizeof(std::uint32_t)});
        }
    }
    return words;
}

}  // namespace

std::vector<std::uint32_t> specialize(const EmbeddedShader& shader, const Specialization& specialization, const Arithmetic& arithmetic)
{
    if (const auto replaced = findReplaced(shader)) {
        return make({shader.name, replaced->data(), replaced->data() + replaced->size()}, specialization, arithmetic);
    }
    static std::mutex mutex;
    static std::map<std::tuple<const std::uint32_t*, Specialization, Arithmetic>, std::vector<std::uint32_t>>
        known;  // .2 s of CPU a render
    const std::tuple key(shader.begin, specialization, arithmetic);
    {
        const std::lock_guard lock(mutex);
        if (const auto entry = known.find(key); entry != known.end()) {
            return entry->second;
        }
    }
    const std::vector<std::uint32_t> specialized = readOrMake(shader, specialization, arithmetic);  // several kernels at a time
    const std::lock_guard lock(mutex);
    if (known.size() >= kMaxKept) {
        known.clear();
    }
    return known.emplace(key, specialized).first->second;
}

}  // namespace glim
