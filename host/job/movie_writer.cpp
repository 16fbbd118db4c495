#include "host/job/movie_writer.hpp"

#include "host/error.hpp"
#include "host/text.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <map>
#include <thread>
#include <utility>

namespace glim {
namespace {

constexpr int kMovieFile = 3;  // ffmpeg's number of the file that it writes

// Players take 4:2:0 alone. The pictures are sRGB, so these are the primaries and the curve; the matrix is that of HD. As options, older
// releases of ffmpeg write them; as parameters of the pictures, newer ones.
constexpr const char* kFilter =
    "scale=out_color_matrix=bt709:out_range=tv:flags=bicubic+accurate_rnd+full_chroma_int,format=yuv420p,"
    "setparams=range=tv:color_primaries=bt709:color_trc=iec61966-2-1:colorspace=bt709";
constexpr const char* kColors[] = {"-color_range", "tv", "-color_primaries", "bt709", "-color_trc", "iec61966-2-1", "-colorspace", "bt709"};

std::vector<std::string> wordsForFfmpeg(const MovieFormat& format, const glm::uvec2& size, double picturesPerSecond)
{
    std::vector<std::string> words{"ffmpeg", "-hide_banner", "-loglevel", "error", "-nostdin", "-y"};
    words.insert(words.end(), {"-f", "rawvideo", "-pixel_format", "rgb24"});
    words.insert(words.end(), {"-video_size", std::to_string(size.x) + "x" + std::to_string(size.y)});
    words.insert(words.end(), {"-framerate", exactText(picturesPerSecond), "-i", "pipe:0", "-vf", kFilter});
    words.insert(words.end(), format.encoding.begin(), format.encoding.end());
    words.insert(words.end(), std::begin(kColors), std::end(kColors));
    words.insert(words.end(), {"-f", format.container, "/proc/self/fd/" + std::to_string(kMovieFile)});
    return words;
}

// Returns the error, 0 if there is none. The program is found by PATH, and no shell is between.
int spawn(pid_t& process, std::vector<std::string> words, int input, int said, int movie)
{
    std::vector<char*> pointers;
    for (std::string& word : words) {
        pointers.push_back(word.data());
    }
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, input, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&files, said, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&files, said, STDERR_FILENO);
    posix_spawn_file_actions_adddup2(&files, movie, kMovieFile);  // the last, since another may have that number here
    const int error = posix_spawnp(&process, pointers.front(), &files, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    return error;
}

[[noreturn]] void refuseProgram(const std::filesystem::path& path, int error)
{
    if (error == ENOENT) {
        throw InputError(MessageId::ProgramMissing,
                         {part::file(path), ": a movie is made by the program ", part::expected("ffmpeg"), ", which is not installed."});
    }
    throw InputError(MessageId::ProgramFailed, {part::file(path), ": cannot be written, since ", part::place("ffmpeg"),
                                                " cannot be started: ", part::value(std::strerror(error)), "."});
}

// The first line that ffmpeg printed, without the part that printed it, as in "[libx264 @ 0x5581] ".
std::string readFirstLine(int said)
{
    std::string text(4096, '\0');
    const ssize_t count = pread(said, text.data(), text.size(), 0);
    text.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    text.resize(std::min(text.find('\n'), text.size()));
    const std::size_t end = text.starts_with('[') ? text.find("] ") : std::string::npos;
    return end == std::string::npos ? text : text.substr(end + 2);
}

}  // namespace

std::optional<MovieFormat> getMovieFormat(const std::filesystem::path& path)
{
    // Both look the same as the pictures. The index comes first in an MP4, so that it plays while it loads.
    static const std::map<std::string, MovieFormat> kFormats{
        {".mp4", {"mp4", {"-c:v", "libx264", "-crf", "18", "-preset", "medium", "-movflags", "+faststart"}}},
        {".webm", {"webm", {"-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-row-mt", "1", "-cpu-used", "4"}}}};
    const auto found = kFormats.find(lowerCase(path.extension().string()));
    return found == kFormats.end() ? std::nullopt : std::optional(found->second);
}

MovieWriter::MovieWriter(const std::filesystem::path& path, const glm::uvec2& size, double picturesPerSecond)
    : path_(path),
      file_(path)
{
    int ends[2] = {-1, -1};
    said_ = memfd_create("what ffmpeg prints", MFD_CLOEXEC);
    int error = said_ < 0 || pipe2(ends, O_CLOEXEC) != 0 ? errno : 0;
    if (error == 0) {
        error = spawn(process_, wordsForFfmpeg(getMovieFormat(path).value(), size, picturesPerSecond), ends[0], said_, file_.descriptor());
        close(ends[0]);
        input_ = ends[1];
    }
    if (error != 0) {
        process_ = 0;
        close(std::exchange(said_, -1));
        closeInput();
        refuseProgram(path, error);
    }
}

MovieWriter::~MovieWriter()
{
    closeInput();
    if (process_ != 0) {
        kill(process_, SIGKILL);
        while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
        }
    }
    if (said_ >= 0) {
        close(said_);
    }
}

void MovieWriter::closeInput()
{
    if (input_ >= 0) {
        close(std::exchange(input_, -1));
    }
}

void MovieWriter::write(std::span<const Rgb8> picture)
{
    std::span<const std::byte> rest = std::as_bytes(picture);
    while (!rest.empty()) {
        const ssize_t count = ::write(input_, rest.data(), rest.size());
        if (count < 0 && errno != EINTR) {
            finish([] { return true; });  // throws what ffmpeg says, unless it has ended without an error
            fail();
        }
        rest = rest.subspan(count > 0 ? static_cast<std::size_t>(count) : 0);
    }
}

bool MovieWriter::finish(const std::function<bool()>& goesOn)
{
    closeInput();
    int status = 0;
    for (pid_t ended = 0; ended == 0;) {
        ended = waitpid(process_, &status, WNOHANG);
        if (ended == 0 && !goesOn()) {
            return false;
        }
        if (ended == 0) {
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
    }
    process_ = 0;
    if (status != 0) {
        fail();
    }
    return true;
}

void MovieWriter::fail()
{
    const std::string line = readFirstLine(said_);
    throw InputError(MessageId::ProgramFailed, {part::file(path_), ": cannot be written, since ", part::place("ffmpeg"),
                                                " failed: ", line.empty() ? part::value("it says nothing") : part::quoted(line), "."});
}

}  // namespace glim
