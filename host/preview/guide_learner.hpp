// Learns a guide for a view that rests, while the window goes on: in a thread of its own, which uses the device only when the window's
// thread waits for it.
#pragma once

#include "host/render/learn_guide.hpp"

#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>

namespace glim {

class GuideLearner {
public:
    GuideLearner() = default;
    ~GuideLearner() { end(); }
    GuideLearner(const GuideLearner&) = delete;
    GuideLearner& operator=(const GuideLearner&) = delete;

    // Begins. Nothing may be under way; renderer and scene must stay as they are until it has ended.
    void begin(const Renderer& renderer, const FlatScene& scene, const FlatCamera& camera);
    // Whether something is under way, be it cancelled.
    bool isWorking() const { return thread_.joinable(); }
    // Lets it work for about a tenth of a second. Returns false if nobody waits for a guide.
    bool advance();
    // The guide, once; null if there is none yet. Throws what learnGuide() threw.
    std::shared_ptr<const Guide> take();
    // What is under way is of no use. It ends soon, if advance() and take() are called.
    void cancel();
    // Cancels it and waits for its end.
    void end();

private:
    bool pause(bool needsDevice);
    bool isDone();

    std::thread thread_;
    std::mutex mutex_;  // of the following
    std::condition_variable changed_;
    bool isItsTurn_ = false;    // to use the device
    bool needsDevice_ = false;  // it waits for its turn
    bool isCancelled_ = false, isDone_ = false;
    std::shared_ptr<const Guide> guide_;
    std::exception_ptr error_;
};

}  // namespace glim
