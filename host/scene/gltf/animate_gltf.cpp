#include "host/scene/gltf/animate_gltf.hpp"

#include "host/message.hpp"
#include "host/scene/gltf/check_gltf_json.hpp"
#include "host/scene/gltf/gltf_schema.hpp"
#include "host/scene/gltf/object_model.hpp"
#include "host/scene/gltf/parse_model.hpp"
#include "host/scene/gltf/place_nodes.hpp"
#include "host/scene/gltf/read_accessor.hpp"
#include "host/text.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <set>

namespace glim {
namespace {

using nlohmann::json;

constexpr const char* kVisible = "nodes[].extensions.KHR_node_visibility.visible";

// A property that an animation changes.
struct Property {
    json* parent = nullptr;  // in the document
    std::string name;        // in its parent: a member, or an index
    bool array = false;      // of `width` numbers; else one number
    bool boolean = false, rotation = false;
    std::size_t width = 1;       // numbers per value
    std::size_t components = 1;  // of the accessor's elements
    double min = 0.0, max = 0.0;
};

class Animator {
public:
    Animator(const GltfFile& file, std::size_t animation, Warnings& warnings)
        : file_(file),
          animation_(file.animations[animation]),
          place_(label("animations", animation, animation_.name)),
          warnings_(warnings),
          document_(*file.document)
    {}

    void apply(std::size_t channel, double seconds);
    json takeDocument() { return std::move(document_); }

private:
    std::optional<Property> findProperty(const std::string& pointer, const std::string& place);
    json* findParent(const std::vector<std::string>& steps);
    void spellOutWeights(const std::vector<std::string>& steps, const std::string& place);
    void replaceMatrix(std::size_t index, const std::string& pointer, const std::string& place);
    std::vector<double> readTimes(const GltfAnimation::Sampler& sampler);
    Keyframes readKeyframes(const GltfAnimation::Sampler& sampler, const Property& property, const std::string& place);
    void set(const Property& property, std::vector<double> value, const std::string& pointer);

    const GltfFile& file_;
    const GltfAnimation& animation_;
    std::string place_;
    Warnings& warnings_;
    json document_;
    std::set<std::string> targets_;  // pointers of the channels so far
};

// What holds the last step; null if the file does not have it.
json* Animator::findParent(const std::vector<std::string>& steps)
{
    json* at = &document_;
    for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
        at = follow(*at, steps[i]);
        if (at == nullptr) {
            return nullptr;
        }
    }
    const bool hasRoom = at->is_object() || follow(*at, steps.back()) != nullptr;  // a member may be left out, an element may not
    return hasRoom ? at : nullptr;
}

// Weights that the file leaves out are those of the mesh, or zeros.
void Animator::spellOutWeights(const std::vector<std::string>& steps, const std::string& place)
{
    json* owner = findParent({steps[0], steps[1], "weights"});
    if (owner == nullptr) {
        return;
    }
    const bool isNode = steps[0] == "nodes";
    const json* mesh = !isNode ? owner : owner->contains("mesh") ? &document_["meshes"][(*owner)["mesh"].get<std::size_t>()] : nullptr;
    const json primitives = mesh == nullptr ? json::array() : (*mesh)["primitives"];
    std::size_t count = 0;
    for (const json& primitive : primitives) {
        count = std::max(count, primitive.value("targets", json::array()).size());
    }
    if (count == 0) {
        refuse(file_, MessageId::Missing,
               {part::place(place), " animates the weights of ", part::value(steps[0] + "[" + steps[1] + "]"),
                ", which has no morph targets; expected ", part::expected("some")});
    }
    if (!owner->contains("weights")) {
        (*owner)["weights"] = mesh->value("weights", json(std::vector<double>(count, 0.0)));
    }
}

std::optional<Property> Animator::findProperty(const std::string& pointer, const std::string& place)
{
    const std::vector<std::string> steps = splitPointer(pointer);
    const std::string path = makeSchemaPath(steps);
    const bool allWeights = path == "nodes[].weights" || path == "meshes[].weights";
    const SchemaRule* rule = findRule(allWeights ? path + "[]" : path);
    const bool vector = rule != nullptr && rule->kind == JsonKind::Numbers && rule->count <= 4;
    if (rule == nullptr || !(vector || rule->kind == JsonKind::Number || path == kVisible)) {
        warnings_.add(MessageId::AnimationIgnored, "animations of properties that glim does not use are ignored", shortened(pointer));
        return std::nullopt;
    }
    if (allWeights || path == "nodes[].weights[]" || path == "meshes[].weights[]") {
        spellOutWeights(steps, place);
    }
    Property property{findParent(steps), steps.back(), allWeights || vector, path == kVisible};
    if (property.parent == nullptr) {
        refuse(file_, MessageId::UnknownName,
               {part::place(place), " points to ", part::value(pointer), "; expected ", part::expected("a property that the file has")});
    }
    const bool moves = path == "nodes[].translation" || path == "nodes[].rotation" || path == "nodes[].scale";
    if (moves && property.parent->contains("matrix")) {
        replaceMatrix(std::stoul(steps[1]), pointer, place);
    }
    property.rotation = vector && rule->count == 4 && steps.back() == "rotation";
    property.components = vector ? rule->count : 1;
    property.width = allWeights ? (*property.parent)["weights"].size() : property.components;
    property.min = rule->min;
    property.max = rule->max;
    return property;
}

// The matrix of a node that moves, in the parts that move.
void Animator::replaceMatrix(std::size_t index, const std::string& pointer, const std::string& place)
{
    json& node = document_["nodes"][index];
    readMatrix(file_, index, node["matrix"].get<std::vector<double>>());  // refuses one that projects
    if (!splitMatrix(node)) {
        refuse(file_, MessageId::Degenerate,
               {part::place(place), " animates ", part::value(pointer), " of a node whose matrix shears or has a scale of 0; expected ",
                part::expected("a node without a matrix")});
    }
    warnings_.add(MessageId::MatrixDecomposed, "matrices of nodes that are animated count as translation, rotation and scale",
                  shortened(pointer));
}

std::vector<double> Animator::readTimes(const GltfAnimation::Sampler& sampler)
{
    constexpr double kTimeRounding = 1e-5;  // relative: of float32, written with six digits
    const std::string use = "times of " + place_;
    std::vector<double> times = readNumbers(file_, sampler.input, 1, use);
    for (std::size_t i = 1; i < times.size(); ++i) {
        const bool jumps = times[i] <= times[i - 1] && times[i - 1] - times[i] <= kTimeRounding * std::abs(times[i]);
        if (jumps) {
            warnings_.add(MessageId::UnorderedKeys, "values jump where times of keys do not increase",
                          "accessors[" + std::to_string(sampler.input) + "] (" + use + ")");
            times[i] = times[i - 1];
        } else if (!(times[i] > times[i - 1])) {
            refuse(file_, MessageId::OutOfRange,
                   {part::place("accessors[" + std::to_string(sampler.input) + "] (" + use + ")"), " holds ", part::value(toText(times[i])),
                    " after ", toText(times[i - 1]), " in element ", std::to_string(i), "; expected ",
                    part::expected("times that do not decrease")});
        }
    }
    return times;
}

Keyframes Animator::readKeyframes(const GltfAnimation::Sampler& sampler, const Property& property, const std::string& place)
{
    Keyframes keyframes{sampler.interpolation, property.rotation, property.width, readTimes(sampler)};
    keyframes.values = readNumbers(file_, sampler.output, property.components, "values of " + place);
    const std::size_t perKey = property.width * (sampler.interpolation == Interpolation::CubicSpline ? 3 : 1);
    if (keyframes.values.size() != keyframes.times.size() * perKey) {
        refuse(file_, MessageId::Mismatch,
               {part::place(place), " has ", part::value(counted(keyframes.values.size() / property.components, "value")), " for ",
                counted(keyframes.times.size(), "time"), "; expected ",
                part::expected(std::to_string(keyframes.times.size() * perKey / property.components))});
    }
    if (property.boolean && sampler.interpolation != Interpolation::Step) {
        refuse(file_, MessageId::WrongType, {part::place(place), " interpolates a boolean property; expected ", part::expected("STEP")});
    }
    return keyframes;
}

void Animator::set(const Property& property, std::vector<double> value, const std::string& pointer)
{
    for (double& number : value) {
        const double clamped = std::clamp(number, property.min, property.max);
        if (clamped != number) {
            warnings_.add(MessageId::AnimatedValueClamped, "animated values outside the range of their property are clamped",
                          shortened(pointer));
            number = clamped;
        }
    }
    json& target = property.parent->is_array() ? (*property.parent)[std::stoul(property.name)] : (*property.parent)[property.name];
    if (property.boolean) {
        target = value[0] != 0.0;
    } else if (property.array) {
        target = value;
    } else {
        target = value[0];
    }
}

void Animator::apply(std::size_t channel, double seconds)
{
    const auto& [sampler, pointer] = animation_.channels[channel];
    const std::string place = place_ + ".channels[" + std::to_string(channel) + "]";
    if (sampler >= animation_.samplers.size()) {
        refuse(file_, MessageId::DanglingIndex,
               {part::place(place + ".sampler"), " is ", part::value(std::to_string(sampler)), "; expected ",
                part::expected("one below " + std::to_string(animation_.samplers.size()))});
    }
    if (pointer.empty()) {
        return;
    }
    if (!targets_.insert(pointer).second) {
        refuse(file_, MessageId::Duplicate,
               {part::place(place), " animates ", part::value(pointer), ", as another channel does; expected ",
                part::expected("one channel for each property")});
    }
    if (const std::optional<Property> property = findProperty(pointer, place)) {
        set(*property, valueAt(readKeyframes(animation_.samplers[sampler], *property, place), seconds), pointer);
    }
}

}  // namespace

double computeDuration(const GltfFile& file, std::size_t animation)
{
    const GltfAnimation& source = file.animations[animation];
    std::set<std::size_t> inputs;
    for (const GltfAnimation::Sampler& sampler : source.samplers) {
        inputs.insert(sampler.input);
    }
    double duration = 0.0;
    for (const std::size_t input : inputs) {
        duration = std::max(duration, readLastNumber(file, input, "times of " + label("animations", animation, source.name)));
    }
    return duration;
}

void animateGltf(GltfFile& file, std::size_t animation, double seconds, Warnings& warnings)
{
    const GltfAnimation& source = file.animations[animation];
    std::uint64_t unbacked = 0;
    for (const GltfAnimation::Channel& channel : source.channels) {
        if (channel.sampler < source.samplers.size()) {
            const GltfAnimation::Sampler& sampler = source.samplers[channel.sampler];
            unbacked += countUnbacked(file, sampler.input) + countUnbacked(file, sampler.output);
        }
    }
    checkUnbacked(file, part::place(label("animations", animation, source.name) + ".channels"), unbacked);
    Animator animator(file, animation, warnings);
    for (std::size_t i = 0; i < file.animations[animation].channels.size(); ++i) {
        animator.apply(i, seconds);
    }
    file.model = parseModel(file.path, animator.takeDocument());
}

void restoreRestPose(GltfFile& file) { file.model = parseModel(file.path, *file.document); }

}  // namespace glim
