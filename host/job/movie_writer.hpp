// A movie file, encoded by the program ffmpeg, which glim starts and neither links nor contains.
#pragma once

#include "host/atomic_file.hpp"
#include "host/image/png.hpp"

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glim {

// How ffmpeg is to write a kind of movie.
struct MovieFormat {
    std::string container;              // ffmpeg's name of it
    std::vector<std::string> encoding;  // words of ffmpeg's command line
};

// The format by the ending of the name: .mp4 or .webm, in upper or lower case. Nothing for other endings.
std::optional<MovieFormat> getMovieFormat(const std::filesystem::path& path);
inline constexpr const char* kMovieEndings = ".mp4 or .webm";

// Takes a movie's pictures one after the other. The file has its name once it is complete; without commit() nothing of it remains.
class MovieWriter {
public:
    // Starts ffmpeg. The size is even. Throws InputError if the file cannot be written or ffmpeg is not installed.
    MovieWriter(const std::filesystem::path& path, const glm::uvec2& size, double picturesPerSecond);
    ~MovieWriter();
    MovieWriter(const MovieWriter&) = delete;
    MovieWriter& operator=(const MovieWriter&) = delete;

    // sRGB, rows from the top. Throws InputError with what ffmpeg says if it has given up.
    void write(std::span<const Rgb8> picture);
    // False if `goesOn`, asked several times a second, ended it: then there is no movie. Throws as write() does.
    bool finish(const std::function<bool()>& goesOn);
    void commit() { file_.commit(); }

private:
    void closeInput();
    [[noreturn]] void fail();

    std::filesystem::path path_;
    AtomicFile file_;
    int input_ = -1, said_ = -1;  // ffmpeg's standard input, and a file with all that it prints
    pid_t process_ = 0;           // 0: it has ended
};

}  // namespace glim
