#include "host/render/check_status.hpp"

#include "host/error.hpp"

namespace glim {

void refuseBrokenStatus(const DeviceDescription& device, const PathBuffers& paths)
{
    const Status status = download<Status>(paths.status(), 1)[0];
    if (status.loopCaps > 0) {
        throw DeviceError(MessageId::DeviceLimit,
                          {"The driver of \"", device.name, "\" cut loops short in ", part::value(std::to_string(status.loopCaps)),
                           " threads (at its limit of iterations), so the picture would be wrong; the scene's BVH takes more steps per ray "
                           "than this driver allows (a newer version of it may have no such limit)."});
    }
    if (status.splatOverflows > 0) {
        throw DeviceError(MessageId::OutOfRange,
                          {"On \"", device.name, "\" ", part::value(std::to_string(status.splatOverflows)),
                           " light paths brought a pixel more light than it can hold, so the picture would be wrong; ",
                           part::place("--caustics"), " off traces no light paths."});
    }
    if (status.overflows > 0) {
        throw DeviceError(MessageId::DriverFailed, {"Queues on \"", device.name, "\" are ", part::value(std::to_string(status.overflows)),
                                                    " entries longer than there are paths, so the picture would be wrong."});
    }
}

}  // namespace glim
