#include "host/takes_more.hpp"

#include <poll.h>

namespace glim {

bool takesMore(int file, int milliseconds)
{
    pollfd poll{file, POLLOUT, 0};
    return ::poll(&poll, 1, milliseconds) > 0 && (poll.revents & POLLOUT) != 0;
}

}  // namespace glim
