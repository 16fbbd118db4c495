#include "host/spirv/validate.hpp"

#include <spirv-tools/libspirv.hpp>

#include <stdexcept>
#include <string>

namespace glim::spirv {

void requireValid(std::span<const std::uint32_t> words)
{
    std::string message;
    spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_2);
    tools.SetMessageConsumer([&message](spv_message_level_t, const char*, const spv_position_t&, const char* text) { message = text; });
    spvtools::ValidatorOptions options;
    options.SetScalarBlockLayout(true);
    if (!tools.Validate(words.data(), words.size(), options)) {
        throw std::runtime_error("its SPIR-V is not valid: " + message);
    }
}

}  // namespace glim::spirv
