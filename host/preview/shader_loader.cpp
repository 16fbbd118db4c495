#include "host/preview/shader_loader.hpp"

#include "host/fingerprint.hpp"
#include "host/text.hpp"

#include <algorithm>
#include <span>
#include <utility>

namespace fs = std::filesystem;

namespace glim {
namespace {

constexpr std::chrono::milliseconds kSavedInterval{100};  // a hundred files take half a millisecond

// One thread for each.
std::map<std::string, CompiledShader> compileAll(const fs::path& folder, const std::vector<EmbeddedShader>& kernels)
{
    std::map<std::string, std::future<CompiledShader>> compiling;
    for (const EmbeddedShader& own : kernels) {
        compiling[own.name] = std::async(std::launch::async, compileShader, folder, own);
    }
    std::map<std::string, CompiledShader> compiled;
    for (auto& [name, kernel] : compiling) {
        compiled[name] = kernel.get();
    }
    return compiled;
}

bool isSame(const ReplacedKernels& a, const ReplacedKernels& b)
{
    return std::ranges::equal(a, b, [](const auto& x, const auto& y) { return x.first == y.first && *x.second == *y.second; });
}

}  // namespace

ShaderLoader::ShaderLoader(fs::path folder)
    : folder_(std::move(folder)),
      compiled_(readStamps()),
      watch_(kSavedInterval, compiled_)
{}

ShaderLoader::Stamps ShaderLoader::readStamps() const
{
    Stamps stamps;
    std::error_code error;
    for (fs::recursive_directory_iterator i(folder_, error), end; !error && i != end; i.increment(error)) {
        const fs::path ending = i->path().extension();
        const bool isShader = ending == ".comp" || ending == ".glsl" || ending == ".h";
        if (const std::optional<FileStamp> stamp = isShader ? readStamp(i->path()) : std::nullopt) {
            stamps[i->path().lexically_relative(folder_)] = *stamp;
        }
    }
    return stamps;
}

// Files that are new, gone or other ones since the last call.
std::set<fs::path> ShaderLoader::takeChanged()
{
    std::set<fs::path> changed;
    if (watch_.hasChanged(compiled_, [this] { return readStamps(); })) {
        const Stamps before = std::exchange(compiled_, watch_.seen());
        const auto note = [&changed](const Stamps& these, const Stamps& others) {
            for (const auto& [file, stamp] : these) {
                const auto other = others.find(file);
                if (other == others.end() || other->second != stamp) {
                    changed.insert(file);
                }
            }
        };
        note(before, compiled_);
        note(compiled_, before);
    }
    return changed;
}

// The kernels in use that are to be compiled. One that does not compile may depend on anything.
std::vector<EmbeddedShader> ShaderLoader::findStale()
{
    const std::set<fs::path> changed = takeChanged();
    std::vector<EmbeddedShader> stale;
    for (const EmbeddedShader& own : kernelsInUse()) {
        const auto known = kernels_.find(own.name);
        const auto isMadeOf = [&known](const fs::path& file) { return !known->second.words || known->second.files.contains(file); };
        if (known == kernels_.end() || std::ranges::any_of(changed, isMadeOf)) {
            stale.push_back(own);
        }
    }
    return stale;
}

bool ShaderLoader::take()
{
    if (!compiling_.valid()) {
        if (std::vector<EmbeddedShader> stale = findStale(); !stale.empty()) {
            compiling_ = std::async(std::launch::async, compileAll, folder_, std::move(stale));
        }
        return false;
    }
    if (compiling_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
        return false;
    }
    for (auto& [name, kernel] : compiling_.get()) {
        kernels_[name] = std::move(kernel);
    }
    return replace();
}

// All or none: a change of a file that several include is one change.
bool ShaderLoader::replace()
{
    ReplacedKernels newest;
    trouble_.clear();
    for (const EmbeddedShader& own : kernelsInUse()) {
        const auto known = kernels_.find(own.name);
        if (known == kernels_.end()) {
            continue;  // used since compiling began
        }
        const CompiledShader& kernel = known->second;
        if (!kernel.words) {
            trouble_ = kernel.trouble;
            return false;
        }
        if (!std::ranges::equal(*kernel.words, own.words())) {
            newest[own.name] = kernel.words;
        }
    }
    if (isSame(newest, replacedKernels())) {
        return false;
    }
    before_ = replacedKernels();
    replaceKernels(std::move(newest));
    return true;
}

void ShaderLoader::refuse(const std::string& why)
{
    replaceKernels(before_);
    trouble_ = why;
}

void ShaderLoader::label(FilmIdentity& identity) const
{
    const ReplacedKernels kernels = replacedKernels();
    if (kernels.empty()) {
        return;
    }
    Fingerprint print;
    for (const auto& [name, words] : kernels) {
        print.addBytes(std::as_bytes(std::span(name)));
        print.add(*words);
    }
    identity.kernels = hexadecimal(print.state());
    identity.settings += " shaders=" + identity.kernels;
}

}  // namespace glim
