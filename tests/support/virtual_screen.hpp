// A screen that nobody sees: an X server of the test's own, and what is on it.
#pragma once

#include "tests/support/scratch_folder.hpp"

#include <array>
#include <cstdint>
#include <vector>

#include <sys/types.h>

namespace glim::test {

class VirtualScreen {
public:
    static constexpr std::uint32_t kWidth = 800, kHeight = 600;

    // `depth` in bits, `density` in dots per inch. Adds a failure to the running test if Xvfb (Debian: xvfb) does not start.
    explicit VirtualScreen(int depth = 24, int density = 96);
    ~VirtualScreen();
    VirtualScreen(const VirtualScreen&) = delete;
    VirtualScreen& operator=(const VirtualScreen&) = delete;

    // For DISPLAY.
    const std::string& name() const { return name_; }
    // Rows of kWidth pixels from the top; empty if it cannot be read. Of 24 bits only.
    std::vector<std::array<int, 3>> pixels() const;
    // pixels() once they have not changed for a quarter of a second.
    std::vector<std::array<int, 3>> calmPixels() const;

private:
    ScratchFolder folder_;
    pid_t process_ = -1;
    std::string name_;
};

}  // namespace glim::test
