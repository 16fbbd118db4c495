// The raw figures of every render of a bench, from which all others follow.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace glim {

// Figures after the same number of samples of every pixel, with an entry for each seed. The points of one seed share samples.
struct BenchPoint {
    std::uint32_t samples = 0;
    std::vector<double> seconds;        // spent sampling; evaluating the picture is not included
    std::vector<double> cpuSeconds;     // of all threads in that time; 0 if unknown
    std::vector<double> kernelSeconds;  // the part of `seconds` spent in kernels on the device; 0 if unknown
    std::vector<double> mean;           // radiance over pixels and channels
    std::vector<double> mse, relMse;    // against the reference, including its own noise (measure/compare_images.hpp)
    std::vector<double> trimmedRelMse;  // without the worst .1 % of the pixels: beside relMse, never instead
};

// The part of every error that the reference's own variance adds; 0 where it is unknown.
struct Floor {
    double mse = 0.0, relMse = 0.0;
    double relMseError = 0.0;  // standard error of relMse for this one reference
    bool known = false;
};

// The error that no number of samples removes, in units of relMSE: the mean product of the errors of two renders of the last point, minus
// the floor.
struct Bias {
    double squared = 0.0;
    double error = 0.0;  // standard error
};

struct StartUp {
    double load = 0.0, build = 0.0, upload = 0.0, compile = 0.0;  // seconds
};

struct SceneBench {
    std::string scene;     // file as given
    std::string picture;   // camera and whatever else identifies the picture, besides the scene
    std::string settings;  // describeSettings of the first seed
    // Words of the command that say what is measured, but for device, seeds and samples. Nothing if they are not known.
    std::optional<std::vector<std::string>> options;
    std::string device, version, schedule;
    std::uint32_t width = 0, height = 0;
    StartUp startUp;
    std::string reference;  // file
    Floor floor;
    std::vector<std::uint32_t> seeds;
    std::vector<BenchPoint> points;  // ascending, each twice the samples of the one before
    Bias bias;
};

}  // namespace glim
