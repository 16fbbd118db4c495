// What the mutators share: libFuzzer's own mutation and random choices that follow from its seed.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

// libFuzzer's: mutates `size` bytes in place to at most `room`, returns how many they are then.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t room);

namespace glim::fuzz {

class Choice {
public:
    explicit Choice(unsigned seed)
        : random_(seed)
    {}
    std::size_t below(std::size_t count) { return random_() % count; }
    bool oneIn(std::size_t count) { return below(count) == 0; }
    template <class Range>
    auto& of(Range& range)
    {
        return range[below(std::size(range))];
    }

private:
    std::minstd_rand random_;
};

// The same for a vector or a string, which may grow by `growth`.
template <class Container>
void mutateBytes(Container& bytes, std::size_t growth)
{
    const std::size_t size = bytes.size();
    bytes.resize(size + growth + 1);
    bytes.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(bytes.data()), size, size + growth + 1));
}

// Copies an input of the mutator's into libFuzzer's buffer; one that does not fit is replaced by a blind mutant of what is there.
template <class Container>
std::size_t handOver(const Container& input, std::uint8_t* data, std::size_t size, std::size_t room)
{
    if (input.empty() || input.size() > room) {
        return LLVMFuzzerMutate(data, size, room);
    }
    std::copy(input.begin(), input.end(), data);
    return input.size();
}

}  // namespace glim::fuzz
