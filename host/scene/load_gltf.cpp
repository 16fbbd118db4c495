#include "host/scene/load_gltf.hpp"

#include "host/error.hpp"
#include "host/message.hpp"
#include "host/scene/check_scene.hpp"
#include "host/scene/estimate_light.hpp"
#include "host/scene/frame_camera.hpp"
#include "host/scene/gltf/animate_gltf.hpp"
#include "host/scene/gltf/edit_gltf.hpp"
#include "host/scene/gltf/extensions.hpp"
#include "host/scene/gltf/isolate_node.hpp"
#include "host/scene/gltf/pose_mesh.hpp"
#include "host/scene/gltf/read_environment.hpp"
#include "host/scene/gltf/read_geometry.hpp"
#include "host/scene/gltf/read_images.hpp"
#include "host/scene/gltf/read_lights.hpp"
#include "host/scene/gltf/read_material.hpp"
#include "host/scene/gltf/read_motion.hpp"
#include "host/scene/join_scenes.hpp"
#include "host/scene/make_floor.hpp"
#include "host/text.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace glim {
namespace {

void noteIgnoredParts(const GltfFile& file, Warnings& warnings)
{
    for (const std::string& extension : file.model.extensionsUsed) {
        // Noted with each material or primitive.
        const bool isNoted = extension.find("_materials_") != std::string::npos || extension == "KHR_gaussian_splatting";
        if (isMissing(extension) && !isNoted) {
            warnings.add(MessageId::ExtensionIgnored, "extensions are ignored", shortened(extension));
        }
    }
}

// In the order of their names.
std::vector<std::string> listExtensions(const GltfFile& file)
{
    std::set<std::string> extensions(file.model.extensionsUsed.begin(), file.model.extensionsUsed.end());
    extensions.insert(file.model.extensionsRequired.begin(), file.model.extensionsRequired.end());
    return {extensions.begin(), extensions.end()};
}

std::vector<Animation> listAnimations(const GltfFile& file)
{
    std::vector<Animation> animations;
    for (std::size_t i = 0; i < file.animations.size(); ++i) {
        animations.push_back({file.animations[i].name, computeDuration(file, i)});
    }
    return animations;
}

std::size_t countAllMorphTargets(const GltfFile& file)
{
    std::size_t count = 0;
    for (const tinygltf::Mesh& mesh : file.model.meshes) {
        count += countMorphTargets(mesh);
    }
    return count;
}

std::string describeAnimation(const std::vector<Animation>& animations, std::size_t index)
{
    const std::string& name = animations[index].name;
    return std::to_string(index) + " (" + (name.empty() ? "" : inQuotes(name) + ", ") + toText(animations[index].duration) + " s)";
}

std::size_t requireAnimation(const GltfFile& file, const std::vector<Animation>& animations, const std::string& choice)
{
    if (const std::optional<std::size_t> found = findAnimation(animations, choice)) {
        return *found;
    }
    std::string known;
    for (std::size_t i = 0; i < std::min(animations.size(), kMaxListed); ++i) {
        known += (known.empty() ? "" : ", ") + describeAnimation(animations, i);
    }
    const MessagePart expected = part::expected(known.empty() ? "no --at and no --frames, since it has none"
                                                              : "one of " + known + moreThanListed(animations.size()));
    if (choice.empty()) {
        refuse(file, MessageId::Missing, {"it has no animation; expected ", expected});
    }
    refuse(file, MessageId::UnknownName, {"it has no animation ", part::quoted(choice), "; expected ", expected});
}

// The rest pose is what the file's nodes, weights and materials say, without any animation.
void chooseTime(GltfFile& file, const LoadOptions& options, std::optional<double> seconds, const std::vector<Animation>& animations,
                Warnings& warnings)
{
    if (seconds) {
        animateGltf(file, requireAnimation(file, animations, options.animation), *seconds, warnings);
    } else if (!animations.empty()) {
        warnings.add(
            {MessageId::RestPose,
             {"the scene is drawn in its rest pose: --at SECONDS poses it by animation ", part::value(describeAnimation(animations, 0)),
              animations.size() == 1 ? "" : ", --animation by another of " + std::to_string(animations.size())}});
    }
}

// Shares of what the camera sees. Below the first one the built-in studio joins the scene's own lights; below the second one a line says
// that it can.
constexpr double kEnoughLit = 1.0 / 3.0, kMostLit = 0.5;

std::vector<std::string> readVariants(const GltfFile& file)
{
    std::vector<std::string> names;
    const auto extension = file.model.extensions.find("KHR_materials_variants");
    const tinygltf::Value variants = extension == file.model.extensions.end() ? tinygltf::Value() : extension->second.Get("variants");
    for (std::size_t i = 0; variants.IsArray() && i < variants.ArrayLen(); ++i) {
        names.push_back(variants.Get(static_cast<int>(i)).Get("name").Get<std::string>());
    }
    return names;
}

std::optional<std::size_t> findVariant(const GltfFile& file, const std::vector<std::string>& variants, const std::string& name)
{
    const auto found = std::find(variants.begin(), variants.end(), name);
    if (name.empty() || found != variants.end()) {
        return name.empty() ? std::nullopt : std::optional<std::size_t>(found - variants.begin());
    }
    std::string known;
    for (std::size_t i = 0; i < std::min(variants.size(), kMaxListed); ++i) {
        known += (known.empty() ? "" : ", ") + inQuotes(variants[i]);
    }
    refuse(file, MessageId::UnknownName,
           {"it has no variant ", part::quoted(name), "; expected ",
            part::expected(known.empty() ? "no --variant, since it has none" : "one of " + known + moreThanListed(variants.size()))});
}

// The file's materials, then the default one. Those of unused ones say nothing.
void readMaterials(const GltfFile& file, const LoadOptions& options, DecodedParts& decoded, Scene& scene, Warnings& warnings)
{
    const std::vector<bool> used = findUsedMaterials(scene);
    Warnings unheard;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const int index = i + 1 < scene.materials.size() ? static_cast<int>(i) : -1;
        scene.materials[i] = readMaterial(file, index, used[i] ? warnings : unheard);
    }
    readImages(file, options, used, decoded, scene, warnings);
    if (used.back()) {
        scene.defaultMaterial = static_cast<std::uint32_t>(scene.materials.size() - 1);
    } else {
        scene.materials.pop_back();
    }
}

template <class Entries>
std::vector<std::string> namesOf(const Entries& entries)
{
    std::vector<std::string> names;
    for (const auto& entry : entries) {
        names.push_back(entry.name);
    }
    return names;
}

// What a framed camera was framed on.
struct Framed {
    Camera camera;
    glm::dvec3 origin;  // of the scene
};

Camera placeFramed(const Framed& framed, const glm::dvec3& origin)
{
    Camera camera = framed.camera;
    camera.position = glm::dvec3(camera.position) + framed.origin - origin;
    return camera;
}

// The options that choose no time, and those that choose neither time nor light.
LoadOptions withoutTime(LoadOptions options)
{
    options.at.reset();
    options.animation.clear();
    return options;
}

LoadOptions withoutLight(LoadOptions options)
{
    const LoadOptions usual;
    options.environment = usual.environment;
    options.environmentRotation = usual.environmentRotation;
    options.environmentStrength = usual.environmentStrength;
    options.environmentBackground = usual.environmentBackground;
    options.sun = usual.sun;
    return withoutTime(std::move(options));
}

// Whether files are read as before.
bool readsAlike(const LoadOptions& a, const LoadOptions& b)
{
    return a.scene == b.scene && a.missingTextures == b.missingTextures && a.confined == b.confined && a.maxTexture == b.maxTexture &&
           a.additions == b.additions;
}

// One file of a scene.
class FilePart {
public:
    FilePart(const std::filesystem::path& path, LoadOptions options, bool isAdded)
        : file_(readGltfFile(path, options.confined)),
          options_(std::move(options)),
          isAdded_(isAdded)
    {
        edit(options_.edits);
        animations_ = listAnimations(file_);
    }

    // Leaves the part as it was if it throws.
    void choose(const LoadOptions& options)
    {
        if (options.edits != options_.edits) {
            edit(options.edits);
        }
        if (withoutLight(options) != withoutLight(options_)) {
            framed_.reset();
        }
        options_ = options;
    }

    // Without the lights and cameras that the options give it.
    // `blurred`: with motions while the options' shutter is open.
    Scene read(std::optional<double> seconds, bool blurred, Warnings& warnings);
    Camera frame(const Scene& scene);

    DecodedParts& decoded() { return decoded_; }
    const tinygltf::Model& model() const { return file_.model; }

private:
    void edit(const std::vector<Edit>& edits)
    {
        for (const std::size_t image : editGltf(file_, edits)) {
            decoded_.forgetImage(image);
        }
        posed_ = false;
    }

    Framed frameRestPose();

    GltfFile file_;
    LoadOptions options_;
    bool isAdded_;
    std::vector<Animation> animations_;
    DecodedParts decoded_;
    ReadMeshes meshes_;
    std::optional<Framed> framed_;  // on the rest pose
    bool posed_ = false;            // the file's model is not in its rest pose
};

Framed FilePart::frameRestPose()
{
    restoreRestPose(file_);
    posed_ = false;
    Scene rest;
    rest.pointRadius = options_.pointRadius;
    rest.lineRadius = options_.lineRadius;
    rest.materials.resize(file_.model.materials.size() + 1);
    ReadMeshes unused;
    Warnings unheard;
    readGeometry(file_, placeNodes(file_, options_, unheard), rest, unused, unheard);
    return {frameCamera(rest, options_.aspectRatio, options_.yfov), rest.origin};
}

Camera FilePart::frame(const Scene& scene)
{
    if (!posed_) {
        return frameCamera(scene, options_.aspectRatio, options_.yfov);
    }
    framed_ = framed_ ? framed_ : frameRestPose();
    return placeFramed(*framed_, scene.origin);
}

Scene FilePart::read(std::optional<double> seconds, bool blurred, Warnings& warnings)
{
    Scene scene;
    scene.variants = readVariants(file_);
    file_.variant = findVariant(file_, scene.variants, options_.variant);
    scene.file = file_.path;
    scene.files = file_.files;
    scene.nodeNames = namesOf(file_.model.nodes);
    scene.meshNames = namesOf(file_.model.meshes);
    scene.animations = animations_;
    scene.extensions = listExtensions(file_);
    scene.skins = file_.skins.size();
    scene.morphTargets = countAllMorphTargets(file_);
    scene.showsBackFaces = options_.showsBackFaces;
    scene.pointRadius = options_.pointRadius;
    scene.lineRadius = options_.lineRadius;
    scene.materials.resize(file_.model.materials.size() + 1);
    warnings.add(file_.warnings);
    warnings.add(file_.editWarnings);
    if (posed_) {
        restoreRestPose(file_);
    }
    if (!isAdded_) {
        chooseTime(file_, options_, seconds, animations_, warnings);
    }
    posed_ = seconds.has_value();
    const std::vector<PlacedNode> nodes = placeNodes(file_, options_, warnings);
    if (!isAdded_) {
        scene.environment = chooseEnvironment(file_, options_, decoded_, scene, warnings);
    }
    noteIgnoredParts(file_, warnings);
    readGeometry(file_, nodes, scene, meshes_, warnings);
    if (!isAdded_) {
        requireShapes(file_, scene);
    }
    readMaterials(file_, options_, decoded_, scene, warnings);
    readLightsAndCameras(file_, nodes, scene, warnings);
    if (blurred && seconds && options_.shutter) {
        scene.shutter = options_.shutter;
        readMotion(file_, options_, requireAnimation(file_, animations_, options_.animation), *seconds, scene, warnings);
    }
    return scene;
}

// Whether the edit's pointer begins with the file's path or name and a #. Absolute paths begin with / as other pointers do.
bool isOf(const Edit& edit, const Addition& addition)
{
    const std::size_t hash = edit.pointer.find("#/");
    const std::string file = edit.pointer.substr(0, hash);
    return hash != std::string::npos && (file == addition.file.string() || file == addition.file.filename());
}

// With pointers as the file has them.
std::vector<Edit> editsOf(const std::vector<Edit>& edits, const Addition& addition)
{
    std::vector<Edit> own;
    for (const Edit& edit : edits) {
        if (isOf(edit, addition)) {
            own.push_back({edit.pointer.substr(edit.pointer.find("#/") + 1), edit.value});
        }
    }
    return own;
}

// Those of no file that is added.
std::vector<Edit> ownEdits(std::vector<Edit> edits, const std::vector<Addition>& additions)
{
    std::erase_if(edits, [&](const Edit& edit) {
        return std::ranges::any_of(additions, [&edit](const Addition& addition) { return isOf(edit, addition); });
    });
    return edits;
}

// Refuses an edit of a file that is not there.
void checkFilesOfEdits(const std::filesystem::path& path, const LoadOptions& options)
{
    for (const Edit& edit : options.edits) {
        std::set<std::string> files;
        for (const Addition& addition : options.additions) {
            if (isOf(edit, addition)) {
                files.insert(inQuotes(addition.file.string()));
            }
        }
        if (files.empty() && !edit.pointer.starts_with('/')) {
            std::string known;
            for (const Addition& addition : options.additions) {
                known += (known.empty() ? "" : ", ") + inQuotes(addition.file.filename().string());
            }
            throw InputError(MessageId::Malformed,
                             {part::file(path.string()), ": --set ", part::place(edit.pointer), ": expected ",
                              part::expected("a pointer that begins with /" +
                                             (known.empty() ? ", since no file is added" : ", or with one of " + known + " and a #")),
                              "."});
        }
        if (files.size() > 1) {
            std::string candidates;
            for (const std::string& file : files) {
                candidates += (candidates.empty() ? "" : ", ") + file;
            }
            throw InputError(MessageId::AmbiguousName,
                             {part::file(path.string()), ": --set ", part::place(edit.pointer),
                              ": several added files have this name; expected ", part::expected("one of " + candidates + " and a #"), "."});
        }
    }
}

}  // namespace

struct SceneFile::Contents {
    struct Place {
        std::size_t part, index;  // part 0 is the scene's own file
    };

    FilePart main;
    std::vector<FilePart> added;
    JoinedMeshes joined, joinedFloor;
    std::optional<Scene> floor;
    std::optional<std::vector<LightGroup>> lightGroups;     // likewise
    std::optional<double> litShare;                         // of the rest pose, so that all frames of an animation have the same light
    std::vector<std::uint32_t> firstNodes, firstMaterials;  // of each part, in the last scene

    Contents(const std::filesystem::path& path, const LoadOptions& options)
        : main(path, mainOptions(options), false)
    {
        for (const Addition& addition : options.additions) {
            added.emplace_back(addition.file, addedOptions(options, addition), true);
        }
    }

    // If it throws, the options before are to be chosen again.
    void choose(const LoadOptions& options)
    {
        main.choose(mainOptions(options));
        for (std::size_t i = 0; i < added.size(); ++i) {
            added[i].choose(addedOptions(options, options.additions[i]));
        }
    }

    const tinygltf::Model& modelOf(std::size_t part) const { return part == 0 ? main.model() : added[part - 1].model(); }

    // `firsts`: firstNodes or firstMaterials.
    static Place placeOf(const std::vector<std::uint32_t>& firsts, std::uint32_t index)
    {
        const auto after = std::ranges::upper_bound(firsts, index);
        return {static_cast<std::size_t>(after - firsts.begin() - 1), index - *(after - 1)};
    }

    static LoadOptions mainOptions(LoadOptions options)
    {
        options.edits = ownEdits(options.edits, options.additions);
        return options;
    }

    static LoadOptions addedOptions(const LoadOptions& options, const Addition& addition)
    {
        LoadOptions own;
        own.missingTextures = options.missingTextures;
        own.confined = options.confined;
        own.maxTexture = options.maxTexture;
        own.edits = editsOf(options.edits, addition);
        return own;
    }
};

SceneFile::SceneFile(const std::filesystem::path& file, const LoadOptions& options)
    : path_(file),
      options_(options)
{
    checkFilesOfEdits(path_, options_);
}

SceneFile::~SceneFile() = default;

Scene SceneFile::read(std::optional<double> seconds, bool blurred, Warnings& warnings)
{
    Scene scene = contents_->main.read(seconds, blurred, warnings);
    if (options_.sun) {
        scene.lights.push_back(lightOf(*options_.sun));
    }
    std::optional<Camera> framed;
    if (scene.cameras.empty() || options_.framed) {
        framed = contents_->main.frame(scene);
    }
    auto node = static_cast<std::uint32_t>(scene.nodeNames.size()), material = static_cast<std::uint32_t>(scene.materials.size());
    contents_->firstNodes = contents_->firstMaterials = {0};
    if (!options_.additions.empty()) {
        std::vector<AddedScene> others;
        for (std::size_t i = 0; i < options_.additions.size(); ++i) {
            Warnings own;
            contents_->firstNodes.push_back(node);
            contents_->firstMaterials.push_back(material);
            others.push_back({contents_->added[i].read(std::nullopt, false, own), options_.additions[i].worldFromFile});
            for (const Message& message : own.messages()) {
                warnings.add(Message(message, {part::file(others.back().scene.file), ": ", message.sentence}));
            }
            node += static_cast<std::uint32_t>(others.back().scene.nodeNames.size());
            material += static_cast<std::uint32_t>(others.back().scene.materials.size());
        }
        scene = joinScenes(std::move(scene), others, contents_->joined);
    }
    if (scene.cameras.empty()) {
        warnings.add(MessageId::FramedCamera, "the scene has no camera: one is framed on its bounding box");
    }
    if (framed) {
        scene.cameras.push_back(*framed);
    }
    return scene;
}

Scene SceneFile::addFloor(Scene scene, bool isPosed)
{
    if (!options_.floor) {
        return scene;
    }
    if (!contents_->floor) {
        Warnings unheard;
        contents_->floor = makeFloor(*options_.floor, isPosed ? read(std::nullopt, false, unheard) : scene);
    }
    return joinScenes(std::move(scene), {{*contents_->floor, glm::dmat4(1.0)}}, contents_->joinedFloor);
}

void SceneFile::markCatchers(Scene& scene) const
{
    for (const std::string& name : options_.catchers) {
        bool isFound = false;
        std::set<std::string> known;
        for (Material& material : scene.materials) {
            material.isCatcher = material.isCatcher || material.name == name;
            isFound = isFound || material.name == name;
            known.insert(inQuotes(material.name));
        }
        if (!isFound) {
            std::string list;
            std::size_t listed = 0;
            for (const std::string& other : known) {
                list += listed++ < kMaxListed ? (list.empty() ? "" : ", ") + other : "";
            }
            throw InputError(MessageId::UnknownName, {part::file(path_), ": ", part::place("--catcher"), " ", part::quoted(name),
                                                      ": no material has this name; expected ",
                                                      part::expected("one of " + list + moreThanListed(known.size())), "."});
        }
    }
}

void SceneFile::chooseLight(Scene& scene, bool isPosed, Warnings& warnings)
{
    // Who gives an environment or a sun has chosen the light.
    if (options_.environment || options_.sun || scene.environment) {
        return;
    }
    if (!hasLight(scene)) {
        scene.environment = makeStudioEnvironment(options_, contents_->main.decoded());
        warnings.add(MessageId::StudioLight, "the scene has no light: the built-in studio lights it (--environment none keeps it dark)");
        return;
    }
    if (!contents_->litShare) {
        Warnings unheard;
        const Scene rest = isPosed ? read(std::nullopt, false, unheard) : Scene();
        const Scene& estimated = isPosed ? rest : scene;
        contents_->litShare = estimateLitShare(estimated, estimated.cameras.front());
    }
    const MessagePart share = part::value(std::to_string(static_cast<int>(100.0 * *contents_->litShare)) + " %");
    if (*contents_->litShare < kEnoughLit) {
        scene.environment = makeStudioEnvironment(options_, contents_->main.decoded());
        warnings.add({MessageId::StudioLight,
                      {"the scene's own lights show ", share,
                       " of what its camera sees: the built-in studio joins them (--environment none leaves it out)"}});
    } else if (*contents_->litShare < kMostLit) {
        warnings.add({MessageId::OwnLight,
                      {"the scene's own lights show ", share, " of what its camera sees; --environment studio adds the built-in studio"}});
    }
}

void SceneFile::addLightGroups(Scene& scene)
{
    if (options_.lightGroups == LightGroupChoice{}) {
        return;
    }
    if (!contents_->lightGroups) {
        contents_->lightGroups = chooseLightGroups(path_, scene, options_.lightGroups);
    }
    assignLightGroups(scene, *contents_->lightGroups);
}

void SceneFile::release() { contents_.reset(); }

Scene SceneFile::sceneAt(std::optional<double> seconds, bool blurred)
{
    if (!contents_) {
        contents_ = std::make_unique<Contents>(path_, options_);
    }
    Warnings warnings;
    Scene scene = addFloor(read(seconds, blurred, warnings), seconds.has_value());
    markCatchers(scene);
    checkScene(scene);
    chooseLight(scene, seconds.has_value(), warnings);
    addLightGroups(scene);
    scene.warnings = warnings.messages();
    return scene;
}

void SceneFile::choose(const LoadOptions& options)
{
    checkFilesOfEdits(path_, options);
    if (contents_ && !readsAlike(options, options_)) {
        auto other = std::make_unique<Contents>(path_, options);
        contents_ = std::move(other);
    } else if (contents_) {
        try {
            contents_->choose(options);
        } catch (const InputError&) {
            contents_->choose(options_);
            throw;
        }
        if (withoutLight(options) != withoutLight(options_)) {
            contents_->litShare.reset();
            contents_->floor.reset();
        }
        if (withoutTime(options) != withoutTime(options_)) {
            contents_->lightGroups.reset();
        }
    }
    options_ = options;
}

std::optional<std::string> SceneFile::pointerToNode(std::uint32_t node) const
{
    const auto [part, index] = Contents::placeOf(contents_->firstNodes, node);
    return index < contents_->modelOf(part).nodes.size() ? std::optional(prefixOf(part) + "/nodes/" + std::to_string(index)) : std::nullopt;
}

std::optional<std::string> SceneFile::pointerToMaterial(std::uint32_t material) const
{
    const auto [part, index] = Contents::placeOf(contents_->firstMaterials, material);
    return index < contents_->modelOf(part).materials.size() ? std::optional(prefixOf(part) + "/materials/" + std::to_string(index))
                                                             : std::nullopt;
}

std::vector<std::string> SceneFile::pointersToOthers(const Scene& scene, std::uint32_t node) const
{
    std::vector<std::set<std::size_t>> drawn(contents_->firstNodes.size());  // by part
    const auto add = [&](const auto& objects) {
        for (const auto& object : objects) {
            if (object.node != kNoIndex) {
                const auto [part, index] = Contents::placeOf(contents_->firstNodes, object.node);
                if (index < contents_->modelOf(part).nodes.size()) {  // it is not the floor
                    drawn[part].insert(index);
                }
            }
        }
    };
    add(scene.instances);
    add(scene.spheres);
    const Contents::Place kept = Contents::placeOf(contents_->firstNodes, node);
    std::vector<std::string> pointers;
    for (std::size_t part = 0; part < drawn.size(); ++part) {
        for (const std::size_t hidden :
             nodesToHide(contents_->modelOf(part), drawn[part], part == kept.part ? std::optional(kept.index) : std::nullopt)) {
            pointers.push_back(prefixOf(part) + "/nodes/" + std::to_string(hidden));
        }
    }
    return pointers;
}

std::string SceneFile::prefixOf(std::size_t part) const
{
    if (part == 0) {
        return "";
    }
    const std::filesystem::path& file = options_.additions[part - 1].file;
    const bool isAmbiguous = std::ranges::any_of(
        options_.additions, [&file](const Addition& other) { return other.file != file && other.file.filename() == file.filename(); });
    return (isAmbiguous ? file : file.filename()).string() + "#";
}

glm::dvec3 SceneFile::translationOf(std::uint32_t node) const
{
    const auto [part, index] = Contents::placeOf(contents_->firstNodes, node);
    const tinygltf::Node& found = contents_->modelOf(part).nodes.at(index);
    const std::vector<double>& numbers = found.matrix.empty() ? found.translation : found.matrix;
    const std::size_t first = found.matrix.empty() ? 0 : 12;
    return numbers.empty() ? glm::dvec3(0.0) : glm::dvec3(numbers[first], numbers[first + 1], numbers[first + 2]);
}

std::optional<std::size_t> findAnimation(const std::vector<Animation>& animations, const std::string& choice)
{
    for (std::size_t i = 0; i < animations.size(); ++i) {
        if (choice.empty() || animations[i].name == choice || std::to_string(i) == choice) {
            return i;
        }
    }
    return std::nullopt;
}

Scene loadGltf(const std::filesystem::path& path, const LoadOptions& options) { return SceneFile(path, options).sceneAt(options.at); }

}  // namespace glim
