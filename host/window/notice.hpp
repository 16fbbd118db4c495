// A sentence that a window shows for a while.
#pragma once

#include <chrono>
#include <string>
#include <utility>

namespace glim {

class Notice {
public:
    void show(const std::string& text)
    {
        text_ = text;
        end_ = std::chrono::steady_clock::now() + std::chrono::seconds(6);
    }
    // Empty if there is none.
    const std::string& text() const { return text_; }
    // True once when its time is over; then there is none.
    bool expire() { return !text_.empty() && std::chrono::steady_clock::now() >= end_ && !std::exchange(text_, "").empty(); }

private:
    std::string text_;
    std::chrono::steady_clock::time_point end_;
};

}  // namespace glim
