#include "host/bvh/parallel_for.hpp"

#include <algorithm>
#include <atomic>
#include <future>
#include <vector>

namespace glim {

void parallelFor(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& work)
{
    std::atomic<std::size_t> next = 0;
    const auto run = [&] {
        for (std::size_t i = next++; i < count; i = next++) {
            work(i);
        }
    };
    std::vector<std::future<void>> others;  // declared last, so that it waits for the threads before what they use is destroyed
    for (std::size_t i = 1; i < std::min<std::size_t>(count, threads); ++i) {
        others.push_back(std::async(std::launch::async, run));
    }
    run();
    for (std::future<void>& other : others) {
        other.get();
    }
}

}  // namespace glim
