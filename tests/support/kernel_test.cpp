#include "tests/support/kernel_test.hpp"

#include "host/render/path_buffers.hpp"
#include "places.h"
#include "shaders/shared/bindings.h"
#include "tests/support/test_data.hpp"

namespace glim {
namespace {

KernelLayout makeLayout()
{
    std::vector<BindingSlot> slots = kernelSlots();
    for (const std::uint32_t binding : {kBindCases, kBindReport, kBindResults}) {
        slots.push_back({binding, BufferKind::Storage});
    }
    return {testDevice(), slots, sizeof(CoursePass)};
}

}  // namespace

KernelTest::KernelTest(const EmbeddedShader& shader)
    : KernelRun(shader, testData("kernels", GLIM_SOURCE_DIR "/tests/kernels"))
{
    specialize(kSpecWorkgroup, kTestWorkgroup);
}

void KernelTest::run()
{
    static const KernelLayout layout = makeLayout();
    Device& device = testDevice();
    push_.pass.pixelCount = threadCount();  // which kernels take for the number of cases
    parameters_.canarySteps = 3;
    const Buffer noChoice(device, "chosen pixels", BufferKind::Storage, 2 * sizeof(uint));
    Buffer status(device, "status", BufferKind::Storage, sizeof(Status));
    upload(status, std::span<const Status>(std::vector<Status>(1)));
    Buffer parameters(device, "test's parameters", BufferKind::Storage, sizeof(RenderParameters));
    upload(parameters, std::span<const RenderParameters>(&parameters_, 1));
    Buffer course(device, "test's parameters of the course", BufferKind::Storage, sizeof(CourseParameters));
    upload(course, std::span<const CourseParameters>(&course_, 1));
    runWith(layout, std::as_bytes(std::span<const CoursePass, 1>(&push_, 1)),
            {{kBindChosenPixels, &noChoice}, {kBindStatus, &status}, {kBindParameters, &parameters}, {kBindCourseParameters, &course}});
}

}  // namespace glim
