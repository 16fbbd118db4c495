#include "host/preview/compile_shader.hpp"

#include "glsl_options.h"
#include "host/error.hpp"
#include "host/render/film_identity.hpp"
#include "host/spirv/interface.hpp"
#include "host/spirv/mark.hpp"
#include "host/spirv/validate.hpp"

#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace fs = std::filesystem;

namespace glim {
namespace {

constexpr const char* kCompiler = "glslangValidator";

// A file without a name, which nothing leaves behind.
class NamelessFile {
public:
    NamelessFile()
        : descriptor_(memfd_create("glim's shader", MFD_CLOEXEC))
    {
        if (descriptor_ < 0) {
            throw std::runtime_error(std::string("no memory for what the compiler writes: ") + std::strerror(errno));
        }
    }
    ~NamelessFile() { close(descriptor_); }
    NamelessFile(const NamelessFile&) = delete;
    NamelessFile& operator=(const NamelessFile&) = delete;

    int descriptor() const { return descriptor_; }
    // By which a program opens it that has inherited the descriptor.
    std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }
    std::string content() const
    {
        struct stat status {};
        std::string bytes(fstat(descriptor_, &status) == 0 ? static_cast<std::size_t>(status.st_size) : 0, '\0');
        const ssize_t count = pread(descriptor_, bytes.data(), bytes.size(), 0);
        bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
        return bytes;
    }

private:
    int descriptor_;
};

// Runs the compiler in `folder` and returns how it ended, as of waitpid(). What it prints goes to `said`; it inherits the other files.
// Throws std::system_error if it cannot be started.
int runCompiler(const fs::path& folder, std::vector<std::string> words, const NamelessFile& said,
                std::initializer_list<const NamelessFile*> others)
{
    words.insert(words.begin(), kCompiler);
    std::vector<char*> pointers;
    for (std::string& word : words) {
        pointers.push_back(word.data());
    }
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    posix_spawn_file_actions_adddup2(&actions, said.descriptor(), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, said.descriptor(), STDERR_FILENO);
    for (const NamelessFile* other : others) {
        posix_spawn_file_actions_adddup2(&actions, other->descriptor(), other->descriptor());  // stays open
    }
    pid_t process = 0;
    const int error = posix_spawnp(&process, kCompiler, &actions, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) {
        throw std::system_error(error, std::generic_category(), std::string(kCompiler) + " cannot be started");
    }
    int status = 0;
    while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
}

// The names in a rule of make, behind its target. Blanks in them are escaped.
std::set<fs::path> readRule(const std::string& rule)
{
    std::set<fs::path> files;
    std::string name;
    for (std::size_t i = std::min(rule.find(": "), rule.size()); i < rule.size(); ++i) {
        if (rule[i] == '\\' && i + 1 < rule.size()) {
            name += rule[++i];
        } else if (rule[i] != ' ' && rule[i] != '\n' && rule[i] != ':') {
            name += rule[i];
        } else if (!name.empty()) {
            files.insert(fs::path(std::exchange(name, "")).lexically_normal());
        }
    }
    return files;
}

// "FILE:LINE: error: ..." of the first error in what the compiler said: "ERROR: FILE:LINE: ...". `kernel` where it names no file.
std::string readError(const std::string& said, const fs::path& folder, const fs::path& kernel)
{
    const std::string sign = "ERROR: ", anywhere = "'' : ", digits = "0123456789";
    const std::size_t begin = said.starts_with(sign) ? 0 : std::min(said.find('\n' + sign), said.size());
    std::string line = said.substr(begin, said.find('\n', begin + 1) - begin);
    line = line.substr(std::min(line.find(sign) + sign.size(), line.size()));
    for (std::size_t colon = line.find(':'); colon != std::string::npos; colon = line.find(':', colon + 1)) {
        const std::size_t end = line.find_first_not_of(digits, colon + 1);
        if (end != std::string::npos && end > colon + 1 && line.compare(end, 2, ": ") == 0) {
            std::string text = line.substr(end + 2);
            text = text.starts_with(anywhere) ? text.substr(anywhere.size()) : text;
            text.erase(0, text.find_first_not_of(' '));
            text.erase(text.find_last_not_of(' ') + 1);
            return (folder / line.substr(0, colon)).lexically_normal().string() + line.substr(colon, end - colon) + ": error: " + text;
        }
    }
    return (folder / kernel).string() + ": error: " + (line.empty() ? kCompiler + std::string(" failed") : line);
}

std::vector<std::uint32_t> wordsOf(const std::string& bytes)
{
    std::vector<std::uint32_t> words(bytes.size() / sizeof(std::uint32_t));
    std::memcpy(words.data(), bytes.data(), words.size() * sizeof(std::uint32_t));
    return words;
}

spirv::Interface interfaceOf(const EmbeddedShader& shader) { return readInterface(spirv::Module(shader.words())); }

// The kernels of films have one layout: what one of them has is bound for all.
void requireFit(const spirv::Module& kernel, const EmbeddedShader& own)
{
    const spirv::Interface interface = readInterface(kernel);
    spirv::Interface host = interfaceOf(own);
    std::string misfit = findMisfit(interface, host);
    const std::vector<EmbeddedShader> films = filmKernels();
    const auto isOwn = [&own](const EmbeddedShader& other) { return own.name == std::string(other.name); };
    if (!misfit.empty() && std::ranges::any_of(films, isOwn)) {
        for (const EmbeddedShader& other : films) {
            const spirv::Interface more = interfaceOf(other);
            for (const auto& [binding, types] : more.bindings) {
                host.bindings[binding].insert(types.begin(), types.end());
            }
            host.capabilities.insert(more.capabilities.begin(), more.capabilities.end());
        }
        misfit = findMisfit(interface, host);
    }
    if (!misfit.empty()) {
        throw std::runtime_error(misfit + ", so it needs a build of glim");
    }
}

void compileFile(CompiledShader& made, const fs::path& folder, const fs::path& kernel, const EmbeddedShader& own)
{
    const NamelessFile said, compiled, rule;
    const int status = runCompiler(folder, {GLIM_GLSL_OPTIONS, "-I.", "--depfile", rule.path(), "-o", compiled.path(), kernel.string()},
                                   said, {&compiled, &rule});
    if (status != 0) {
        made.trouble = readError(said.content(), folder, kernel);
        return;
    }
    spirv::Module module(wordsOf(compiled.content()));
    markFloats(module);
    std::vector<std::uint32_t> words = module.assemble();
    spirv::requireValid(words);
    requireFit(module, own);
    made.words = std::make_shared<const std::vector<std::uint32_t>>(std::move(words));
    made.files = readRule(rule.content());
}

}  // namespace

std::map<std::string, fs::path> findKernels(const fs::path& folder)
{
    std::map<std::string, fs::path> kernels;
    std::error_code error;
    for (fs::recursive_directory_iterator i(folder / "kernels", error), end; !error && i != end; i.increment(error)) {
        if (i->path().extension() == ".comp") {
            kernels[i->path().stem().string()] = i->path().lexically_relative(folder);
        }
    }
    return kernels;
}

void requireShaders(const fs::path& folder)
{
    if (findKernels(folder).empty()) {
        throw UsageError(MessageId::Empty,
                         {part::place("--shaders"), ": ", part::quoted(folder.string()), ": there are no kernels, expected ",
                          part::expected("a folder like glim's shaders/, with kernels/*.comp")});
    }
    try {
        runCompiler(folder, {"--version"}, NamelessFile(), {});
    } catch (const std::system_error& error) {
        const bool isMissing = error.code() == std::errc::no_such_file_or_directory;
        throw UsageError(isMissing ? MessageId::ProgramMissing : MessageId::ProgramFailed,
                         {part::place("--shaders"), ": kernels are compiled by the program ", part::expected(kCompiler),
                          isMissing ? ", which is not installed (Debian's glslang-tools)" : ", which cannot be started: ",
                          part::value(isMissing ? "" : error.code().message())});
    }
}

CompiledShader compileShader(const fs::path& folder, const EmbeddedShader& own)
{
    CompiledShader made;
    const std::map<std::string, fs::path> kernels = findKernels(folder);
    const auto kernel = kernels.find(own.name);
    if (kernel == kernels.end()) {
        made.trouble = (folder / "kernels").string() + ": error: there is no " + own.name + ".comp";
        return made;
    }
    try {
        compileFile(made, folder, kernel->second, own);
    } catch (const std::exception& error) {
        made.trouble = (folder / kernel->second).string() + ": error: " + error.what();
    }
    return made;
}

}  // namespace glim
