// Denoises a picture that is left alone, in pieces between which the window answers.
#pragma once

#include "host/denoise/denoised_picture.hpp"
#include "host/denoise/nl_means.hpp"
#include "host/preview/refiner.hpp"

#include <future>
#include <string>

namespace glim {

class IdleDenoiser {
public:
    // Calls `beforeCompiling` before its kernels are compiled, which takes a moment.
    IdleDenoiser(Device& device, std::function<void()> beforeCompiling)
        : device_(device),
          beforeCompiling_(std::move(beforeCompiling))
    {}

    // Forgets the picture: another one begins.
    void restart();
    // Kernels have changed. The picture begins anew.
    void renew();
    // Works for about 100 ms, but ends earlier once `shouldContinue` returns false. Begins when both halves of the samples tell their
    // variance, and again whenever the smaller half has doubled or the picture is done. Returns false if there is nothing to do.
    bool work(Refiner& refiner, const std::function<bool()>& shouldContinue);

    struct Result {
        DenoisedPicture picture;
        std::uint32_t samples = 0;
        std::uint64_t version = 0;  // unique
    };
    // The last one of the present picture; null if there is none.
    const Result* result() const { return result_ ? &*result_ : nullptr; }
    bool isWorking() const { return job_ || (measuring_.valid() && !isStale_); }

private:
    struct Job {
        glm::uvec2 size;
        std::array<DenoisedHalf, 2> halves;
        std::size_t half = 0;  // under way
        std::unique_ptr<NlMeans::Work> work;
    };
    bool begin(Refiner& refiner);
    void take();

    Device& device_;
    std::function<void()> beforeCompiling_;
    std::optional<NlMeans> nlMeans_;
    std::optional<Job> job_;
    std::uint32_t samples_ = 0, smaller_ = 0;  // of the last job, and of the smaller of its halves; 0: there was none
    std::future<DenoisedPicture> measuring_;   // in a thread of its own
    bool isStale_ = false;                     // what is measured is of an earlier picture
    std::optional<Result> result_;
    std::uint64_t version_ = 0;
};

// The lines of the panel. What is known of the errors stays when the user sees the noisy picture, and it no longer `works`.
std::vector<std::string> describe(const IdleDenoiser& denoiser, bool works);

}  // namespace glim
