#include "host/gpu/replaced_kernels.hpp"

#include <mutex>
#include <utility>

namespace glim {
namespace {

struct Replacement {
    std::mutex mutex;  // kernels are made in several threads
    ReplacedKernels kernels;
    std::uint32_t count = 0;  // of those so far
    std::map<std::string, EmbeddedShader> used;
};

Replacement& ofProcess()
{
    static Replacement replacement;
    return replacement;
}

}  // namespace

void replaceKernels(ReplacedKernels by)
{
    Replacement& now = ofProcess();
    const std::lock_guard lock(now.mutex);
    now.kernels = std::move(by);
    ++now.count;
}

ReplacedKernels replacedKernels()
{
    Replacement& now = ofProcess();
    const std::lock_guard lock(now.mutex);
    return now.kernels;
}

std::uint32_t replacedVersion()
{
    Replacement& now = ofProcess();
    const std::lock_guard lock(now.mutex);
    return now.kernels.empty() ? 0 : now.count;
}

std::shared_ptr<const std::vector<std::uint32_t>> findReplaced(const EmbeddedShader& own)
{
    Replacement& now = ofProcess();
    const std::lock_guard lock(now.mutex);
    now.used.emplace(own.name, own);
    const auto found = now.kernels.find(own.name);
    return found == now.kernels.end() ? nullptr : found->second;
}

std::vector<EmbeddedShader> kernelsInUse()
{
    Replacement& now = ofProcess();
    const std::lock_guard lock(now.mutex);
    std::vector<EmbeddedShader> kernels;
    for (const auto& [name, own] : now.used) {
        kernels.push_back(own);
    }
    return kernels;
}

}  // namespace glim
