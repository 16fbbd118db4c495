// A window in the main thread, and what it shows in another.
#pragma once

#include "host/window/window.hpp"

#include <exception>
#include <thread>

namespace glim {

// Calls `work` in a thread of its own while the window takes the user's input and the script's. Returns when `work` has returned; rethrows
// what it has thrown.
template <class Work>
void runWindow(Window& window, const std::vector<ScriptStep>& script, Work&& work)
{
    std::exception_ptr failure;
    std::thread worker([&] {
        try {
            work();
        } catch (...) {
            failure = std::current_exception();
        }
        window.finish();
    });
    window.run(script);
    worker.join();
    if (failure) {
        std::rethrow_exception(failure);
    }
}

}  // namespace glim
