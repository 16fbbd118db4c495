// Reads accessors of every kind (dense, interleaved, sparse, normalised) into plain arrays.
#pragma once

#include "host/scene/gltf/gltf_file.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <map>

namespace glim {

// `use` says what the accessor is for in messages: "POSITION of meshes[0].primitives[1]".
// Value is glm::dvec3, glm::dvec4, glm::vec2 or glm::vec4; a vec4 may also come from VEC3, then with w = 1. Values may be NaN or infinite.
template <class Value>
std::vector<Value> readVectors(const GltfFile& file, std::size_t accessor, const std::string& use);

// An attribute of a primitive or of a morph target; empty if there is none. `plural` says what it holds in messages: "normals".
template <class Value>
std::vector<Value> readAttribute(const GltfFile& file, const std::map<std::string, int>& attributes, const std::string& attribute,
                                 const std::string& plural, std::size_t vertexCount, const std::string& place);

// 1 to 4 finite numbers per element, one element after the other.
std::vector<double> readNumbers(const GltfFile& file, std::size_t accessor, std::size_t components, const std::string& use);
// The last of scalars, without the others: any number of animations may name the same times.
double readLastNumber(const GltfFile& file, std::size_t accessor, const std::string& use);

std::vector<glm::dmat4> readMatrices(const GltfFile& file, std::size_t accessor, const std::string& use);

std::vector<std::uint32_t> readIndices(const GltfFile& file, std::size_t accessor, const std::string& use);

// Elements that the file's own bytes do not hold: they are zeros, or compressed. Whoever names them again reads them again.
std::uint64_t countUnbacked(const GltfFile& file, std::size_t accessor);

// How many of them a file of so many bytes may use.
std::uint64_t countMostUnbacked(std::uint64_t ownBytes);

// Refuses more, before they are read. `user` says what reads them, in the plural.
void checkUnbacked(const GltfFile& file, const MessagePart& user, std::uint64_t count);

}  // namespace glim
