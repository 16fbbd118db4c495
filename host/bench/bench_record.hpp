// What a bench has measured: raw figures of every render, from which all others follow.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace glim {

// After the same number of samples of every pixel; an entry for each seed. The points of one seed share their samples.
struct BenchPoint {
    std::uint32_t samples = 0;
    std::vector<double> seconds;        // spent sampling; looking at the picture is no part of it
    std::vector<double> kernelSeconds;  // of them on the device, in kernels; 0 where it cannot tell
    std::vector<double> mean;           // radiance over pixels and channels
    std::vector<double> mse, relMse;    // from the reference, whose own noise is still in them (measure/compare_images.hpp)
    std::vector<double> trimmedRelMse;  // without the .1 % of the pixels that are worst: beside relMse, never instead
};

// What the reference's own variance adds to every error; 0 where it is unknown.
struct Floor {
    double mse = 0.0, relMse = 0.0;
    double relMseError = 0.0;  // standard error of relMse as the floor of this one reference
    bool known = false;
};

// What no number of samples takes away, in units of relMSE: the mean product of the errors of two renders of the last point,
// less the floor.
struct Bias {
    double squared = 0.0;
    double error = 0.0;  // standard error
};

struct StartUp {
    double load = 0.0, build = 0.0, upload = 0.0, compile = 0.0;  // seconds
};

struct SceneBench {
    std::string scene;     // file as given
    std::string picture;   // camera and whatever else says what the picture is of, besides the scene
    std::string settings;  // describeSettings of the first seed
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
