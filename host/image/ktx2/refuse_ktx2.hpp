// What is wrong with a KTX2, as a sentence without the image's name, as in "is a broken KTX2: its first slice has 7 bytes; expected more".
#pragma once

#include "host/error.hpp"

#include <string>

namespace glim {

[[noreturn]] inline void refuseKtx2(const std::string& what, const std::string& value, const std::string& expected)
{
    throw InputError(MessageId::FileDamaged,
                     {"is a broken KTX2: ", what, " ", part::value(value), "; expected ", part::expected(expected)});
}

// The file may be right.
[[noreturn]] inline void refuseKtx2Kind(const std::string& value, const std::string& expected)
{
    throw InputError(MessageId::Unsupported, {"is a KTX2 ", part::value(value), "; expected ", part::expected(expected)});
}

}  // namespace glim
