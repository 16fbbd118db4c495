// The tables of albedos, as kernels read them at kBindAlbedos.
#pragma once

#include "host/flatten/albedo_table.hpp"
#include "host/gpu/buffer.hpp"
#include "shaders/shared/bindings.h"
#include "tests/harness/test_device.hpp"

#include <map>

namespace glim {

class AlbedoBuffer {
public:
    AlbedoBuffer()
        : buffer_(testDevice(), "albedo table", BufferKind::Texel, table().size() * sizeof(uvec4))
    {
        upload(buffer_, std::span<const uvec4>(table()));
    }
    std::map<std::uint32_t, const Buffer*> bound() const { return {{kBindAlbedos, &buffer_}}; }

private:
    static const std::vector<uvec4>& table()
    {
        static const std::vector<uvec4> kTable = [] {
            std::vector<uvec4> all = makeAlbedoTable();
            const std::vector<uvec4> sheen = makeSheenTable();
            all.insert(all.end(), sheen.begin(), sheen.end());
            const std::vector<uvec4> anisotropic = makeAnisotropicAlbedoTable();
            all.insert(all.end(), anisotropic.begin(), anisotropic.end());
            const std::vector<uvec4> glass = makeGlassAlbedoTable();
            all.insert(all.end(), glass.begin(), glass.end());
            return all;
        }();
        return kTable;
    }

    Buffer buffer_;
};

}  // namespace glim
