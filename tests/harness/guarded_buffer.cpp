#include "tests/harness/guarded_buffer.hpp"

#include "host/gpu/commands.hpp"
#include "tests/harness/interface.h"

#include <algorithm>

namespace glim {
namespace {

const std::vector<std::uint32_t>& guard()
{
    static const std::vector<std::uint32_t> words(kTestWorkgroup * 64 / sizeof(kSentinel), kSentinel);
    return words;
}

}  // namespace

GuardedBuffer::GuardedBuffer(Device& device, const std::string& name, std::span<const std::byte> content)
    : device_(&device),
      size_(content.size()),
      buffer_(device, name, BufferKind::Storage, size_ + std::as_bytes(std::span(guard())).size())
{
    std::vector<std::byte> bytes(content.begin(), content.end());
    const auto behind = std::as_bytes(std::span(guard()));
    bytes.insert(bytes.end(), behind.begin(), behind.end());
    buffer_.upload(bytes);
}

std::optional<std::uint64_t> GuardedBuffer::firstOverwritten() const
{
    const auto before = std::as_bytes(std::span(guard()));
    const Buffer copy(*device_, "guard of a buffer", BufferKind::Storage, before.size());
    Commands commands(*device_);
    commands.copy(buffer_.handle(), size_, copy.handle(), before.size());
    commands.submitAndWait();
    const auto now = download<std::byte>(copy, before.size());
    const auto [different, _] = std::ranges::mismatch(now, before);
    return different == now.end() ? std::nullopt : std::optional<std::uint64_t>(different - now.begin());
}

}  // namespace glim
