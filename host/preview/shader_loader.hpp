// Compiles the kernels that the session uses from a folder of shaders, in threads of their own, and again whenever one of their files
// changes.
#pragma once

#include "host/gpu/replaced_kernels.hpp"
#include "host/preview/compile_shader.hpp"
#include "host/preview/stamps.hpp"
#include "host/render/film.hpp"

#include <future>

namespace glim {

class ShaderLoader {
public:
    explicit ShaderLoader(std::filesystem::path folder);

    // Puts the kernels in place of those before once all that are used have been compiled, and some differ. Returns whether it did:
    // pictures are to begin anew then. To be called now and then, while no kernel is made.
    bool take();
    // Why the folder's kernels are not taken as they are now; empty if they are.
    const std::string& trouble() const { return trouble_; }
    // The device refuses what was taken last: takes back the kernels before.
    void refuse(const std::string& why);
    // Says in a film by which kernels it is.
    void label(FilmIdentity& identity) const;

private:
    using Stamps = std::map<std::filesystem::path, FileStamp>;
    using Compiled = std::map<std::string, CompiledShader>;

    Stamps readStamps() const;
    std::set<std::filesystem::path> takeChanged();
    std::vector<EmbeddedShader> findStale();
    bool replace();

    std::filesystem::path folder_;
    Stamps compiled_;  // of the files when compiling began
    StampWatch<Stamps> watch_;
    Compiled kernels_;        // the newest, by name
    ReplacedKernels before_;  // those in place before the last were taken
    std::string trouble_;
    std::future<Compiled> compiling_;
};

}  // namespace glim
