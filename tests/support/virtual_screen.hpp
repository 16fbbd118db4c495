// A virtual screen: an X server that draws into memory.
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

    // `depth` is in bits, `density` in dots per inch. Adds a failure to the running test if Xvfb (Debian: xvfb) does not start.
    explicit VirtualScreen(int depth = 24, int density = 96);
    ~VirtualScreen();
    VirtualScreen(const VirtualScreen&) = delete;
    VirtualScreen& operator=(const VirtualScreen&) = delete;

    // The value of DISPLAY.
    const std::string& name() const { return name_; }
    // Rows of kWidth pixels from the top. The depth must be 24.
    std::vector<std::array<int, 3>> pixels() const;
    // Waits until the pixels have not changed for a quarter of a second.
    std::vector<std::array<int, 3>> calmPixels() const;

private:
    ScratchFolder folder_;
    pid_t process_ = -1;
    std::string name_;
};

}  // namespace glim::test
