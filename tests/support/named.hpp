// A parameter of a test and the name that it has in the name of the test.
#pragma once

#include <gtest/gtest.h>

#include <ostream>
#include <string>

namespace glim::test {

template <class Value>
struct Named {
    const char* name;
    Value value;
};

template <class Value>
Named(const char*, Value) -> Named<Value>;

// Read by GoogleTest.
template <class Value>
void PrintTo(const Named<Value>& named, std::ostream* out)
{
    *out << named.name;
}

// For INSTANTIATE_TEST_SUITE_P.
inline constexpr auto nameOfParameter = [](const auto& info) { return std::string(info.param.name); };

}  // namespace glim::test
