// Makes libjpeg return to where setjmp was called, instead of ending the program. The jump passes no destructor.
#pragma once

#include <cstdio>  // jpeglib.h needs it before itself

#include <jpeglib.h>

#include <csetjmp>

namespace glim {

struct JpegErrors {
    jpeg_error_mgr base;
    std::jmp_buf leave;
    char message[JMSG_LENGTH_MAX];
    bool noEnd;  // the data ended without an end marker
};

[[noreturn]] inline void leaveJpeg(j_common_ptr jpeg)
{
    auto& errors = *reinterpret_cast<JpegErrors*>(jpeg->err);
    errors.base.format_message(jpeg, errors.message);
    std::longjmp(errors.leave, 1);
}

}  // namespace glim
