// The C++ side of `import glim`. Keyword arguments are the options of a job.
#include "host/atomic_file.hpp"
#include "host/gpu/device.hpp"
#include "host/image/exr.hpp"
#include "host/job/focus.hpp"
#include "host/job/render_picture.hpp"
#include "host/job/render_report.hpp"
#include "host/job/surface_files.hpp"
#include "host/render/film_pictures.hpp"
#include "host/render/identify.hpp"
#include "host/render/merge_films.hpp"
#include "host/render/seen_instances.hpp"
#include "python/film.hpp"
#include "shaders/shared/limits.h"

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <deque>
#include <exception>
#include <iterator>
#include <mutex>
#include <string_view>

namespace nb = nanobind;

namespace glim {
namespace {

// One picture at a time: the scenes of a process share its device.
std::mutex rendering;
// The process that has used Vulkan, which does not survive fork(); 0: none has.
std::atomic<pid_t> user = 0;

void refuseFork()
{
    pid_t nobody = 0;
    if (!user.compare_exchange_strong(nobody, getpid()) && nobody != getpid()) {
        throw DeviceError(MessageId::Unsupported,
                          {"this process was forked from one that has used glim, and Vulkan does not survive that; start it anew, as "
                           "multiprocessing's method spawn does."});
    }
}

// Options that write files or make several pictures: in Python the caller does that.
constexpr const char* kRefused[] = {"--image",     "--rates", "--layers",     "--compression", "--ids",           "--surfaces", "--flow",
                                    "--objects",   "--stats", "--checkpoint", "--resume",      "--on-checkpoint", "--progress", "--frames",
                                    "--turntable", "--movie", "--cameras",    "--replay",      "--suspects"};

// The Json of a Python value: bytes, a bool, a number, a list of bytes and numbers, or a dict of these (glim/_options.py).
Json valueOf(nb::handle value)
{
    if (nb::isinstance<nb::bool_>(value)) {
        return nb::cast<bool>(value);
    }
    if (nb::isinstance<nb::int_>(value)) {
        return nb::cast<std::int64_t>(value);
    }
    if (nb::isinstance<nb::float_>(value)) {
        return nb::cast<double>(value);
    }
    if (nb::isinstance<nb::bytes>(value)) {
        const auto bytes = nb::cast<nb::bytes>(value);
        return std::string(bytes.c_str(), bytes.size());
    }
    if (nb::isinstance<nb::dict>(value)) {
        Json object = Json::object();
        for (const auto& [name, member] : nb::cast<nb::dict>(value)) {
            object.set(nb::cast<std::string>(name), valueOf(member));
        }
        return object;
    }
    Json list = Json::array();
    for (const nb::handle element : nb::cast<nb::list>(value)) {
        list.append(valueOf(element));
    }
    return list;
}

// `allowed`: one of kRefused.
RenderJob jobOf(const nb::dict& values, std::string_view allowed = "")
{
    RenderJob job;
    OptionTable table;
    addJobOptions(table, job);
    table.option("--output").require(false);
    table.setAll(valueOf(values));
    for (const char* name : kRefused) {
        if (name != allowed && table.isGiven(name)) {
            throw UsageError(MessageId::Unsupported, {part::place(name), ": is for the command line alone"});
        }
    }
    table.finish();
    return job;
}

// The options of a job, for the types in glim/_render_options.py.
nb::list options()
{
    constexpr std::array kKinds{"other", "flag", "text", "path", "whole", "number", "choice"};
    RenderJob job;
    OptionTable table;
    addJobOptions(table, job);
    const std::deque<OptionTable::Entry>& entries = table.entries();
    const auto isRefused = [](const OptionTable::Entry& entry) {
        return entry.isArgument() || entry.name() == "--output" || std::ranges::find(kRefused, entry.name()) != std::end(kRefused);
    };
    nb::list list;
    for (const OptionTable::Entry& entry : entries) {
        if (isRefused(entry) || std::ranges::any_of(entry.needs, [&](std::size_t other) { return isRefused(entries[other]); })) {
            continue;
        }
        nb::dict option;
        option["name"] = entry.name();
        option["unit"] = entry.unit;
        option["help"] = entry.help;
        option["kind"] = kKinds.at(static_cast<std::size_t>(entry.kind));
        option["choices"] = entry.choices;
        list.append(option);
    }
    return list;
}

// Asks Python whether a render goes on. Python's exceptions wait until the film is done.
class Watcher {
public:
    explicit Watcher(nb::object progress)
        : progress_(std::move(progress))
    {}

    bool operator()(const RenderProgress& now)
    {
        return goesOn([&] {
            if (!progress_.is_none()) {
                progress_(now.samples, now.totalSamples, now.seconds);
            }
        });
    }

    // Before the first sample.
    bool goesOn()
    {
        return goesOn([] {});
    }

    std::exception_ptr failure() const { return failure_; }

private:
    template <class Call>
    bool goesOn(Call call)
    {
        const nb::gil_scoped_acquire gil;
        try {
            if (PyErr_CheckSignals() != 0) {
                throw nb::python_error();
            }
            call();
        } catch (const nb::python_error&) {
            failure_ = std::current_exception();
        }
        return !failure_;
    }

    nb::object progress_;
    std::exception_ptr failure_;
};

// What a film is to know besides the picture.
struct Wanted {
    bool ids = false, surfaces = false, objects = false;
    std::optional<double> flow;  // seconds, of the surfaces
};

struct RayKernels {
    std::shared_ptr<const CameraRayKernels> ofSamples, ofCenters;
    FocusFinder focus;
};

class PythonScene {
public:
    // The last film of this scene, also if it was stopped; null if there is none, or if the last one had no sample.
    std::shared_ptr<PythonFilm> lastFilm() const { return lastFilm_; }

    std::shared_ptr<PythonFilm> render(const nb::dict& values, const std::shared_ptr<PythonFilm>& resumed, const Wanted& wanted,
                                       nb::object progress)
    {
        refuseFork();
        RenderJob options = jobOf(values);
        options.flow = wanted.flow;
        Watcher watcher(std::move(progress));
        {
            const nb::gil_scoped_release release;
            const std::lock_guard lock(rendering);
            lastFilm_ = renderWithin(options, resumed.get(), wanted, watcher);
        }
        if (watcher.failure()) {
            std::rethrow_exception(watcher.failure());
        }
        return lastFilm_;
    }

    // From, at and up of each picture of a turntable.
    std::vector<std::array<std::array<double, 3>, 3>> turntable(const nb::dict& values)
    {
        refuseFork();
        const RenderJob options = jobOf(values, "--turntable");
        const nb::gil_scoped_release release;
        const std::lock_guard lock(rendering);
        auto [session, rayKernels] = takeSession(options);
        std::vector<std::array<std::array<double, 3>, 3>> poses;
        for (const Shot& shot : listShots(options.sequence, options, session->prepared().scene)) {
            const auto numbers = [](const glm::dvec3& point) { return std::array{point.x, point.y, point.z}; };
            poses.push_back({numbers(shot.pose->from), numbers(shot.pose->at), numbers(shot.pose->up)});
        }
        keep(std::move(session), std::move(rayKernels));
        return poses;
    }

private:
    using Session = std::pair<std::unique_ptr<SceneSession>, RayKernels>;

    // A session that is posed for the options. None stays if anything is thrown before keep().
    Session takeSession(const RenderJob& options)
    {
        if (session_ && session_->serves(options)) {
            session_->pose(options.edits, options.at);  // what the scene refuses changes nothing
        }
        // The kernels go before the device, which the session has.
        std::unique_ptr<SceneSession> session = std::move(session_);
        RayKernels rayKernels = std::move(rayKernels_);
        if (!session || !session->serves(options)) {
            rayKernels = {};
            session.reset();
            session = std::make_unique<SceneSession>(options);
        }
        session->pose(options.edits, options.at);
        return {std::move(session), std::move(rayKernels)};
    }

    std::shared_ptr<PythonFilm> renderWithin(const RenderJob& asked, const PythonFilm* resumed, const Wanted& wanted, Watcher& watcher)
    {
        auto [session, rayKernels] = takeSession(asked);
        const RenderJob options = rayKernels.focus.resolve(asked, *session);
        if (options.settings.aov == Aov::Radiance) {
            warnIfNoLights(session->prepared());
        }
        session->denoiser().open(options);
        PictureFrame frame = framePicture(*session, options);
        if (options.guiding != GuidingChoice::Off) {
            learnGuide(*session, options, frame, [&](const LearningPause&) { return watcher.goesOn(); });  // or takes the session's
        }
        if (watcher.failure()) {
            keep(std::move(session), std::move(rayKernels));
            return nullptr;
        }
        if (resumed != nullptr) {
            if (const std::optional<Message> difference = findOther(resumed->film(), *session, frame, options)) {
                throw InputError(Message(*difference, {"the film cannot be resumed: ", difference->sentence, "."}));
            }
        }
        Renderer& renderer = session->begin(frame.camera, frame.settings);
        if (resumed != nullptr) {
            resumeFrom(renderer, resumed->stored(), "the film");
        }
        // Of whole pages by uniform sampling the film says all but halves.
        const bool wholePages =
            frame.settings.adaptive == Adaptive::Off && frame.settings.sampleEnd % kPageSamples == 0 && !frame.settings.halves;
        RenderedFilm rendered = renderPicture(renderer, options, session->denoiser(), std::ref(watcher),
                                              [&] { return !wholePages || !renderer.plan().isDone(); });
        if (renderer.statistics().samples + renderer.statistics().resumedSamples == 0) {
            keep(std::move(session), std::move(rayKernels));
            return nullptr;
        }
        labelFilm(rendered.film, options, frame);
        warnIfUnknown(rendered);
        warnOfPicture(rendered.film, renderer.statistics(), options.settings);
        auto film = std::make_shared<PythonFilm>(std::move(rendered.film), std::move(rendered.checkpoint));
        film->setDenoising(std::move(rendered.denoising));
        if (wanted.ids) {
            Identifier identifier(renderer, session->prepared(), frame.camera, rayKernels.ofSamples);
            film->identify(identifier);
            rayKernels.ofSamples = identifier.kernels();
        }
        if (wanted.surfaces || wanted.objects) {
            const SceneInstances instances(session->prepared().scene);
            const std::optional<Flow> flow = makeFlow(*session, options, frame);
            SurfaceTracer tracer(renderer, session->prepared(), frame.camera, instances, flow ? &*flow : nullptr, rayKernels.ofCenters);
            const glm::uvec2 size(film->film().width, film->film().height);
            if (wanted.surfaces) {
                film->setSurfaces(tracer.rows(size.x, 0, size.y));
            }
            if (wanted.objects) {
                film->setObjects(describeSeenInstances(tracer, instances, size, "").dump());
            }
            rayKernels.ofCenters = tracer.kernels();
        }
        keep(std::move(session), std::move(rayKernels));
        if (rendered.denoisingError) {
            lastFilm_ = film;
            std::rethrow_exception(rendered.denoisingError);
        }
        return film;
    }

    void keep(std::unique_ptr<SceneSession> session, RayKernels rayKernels)
    {
        session_ = std::move(session);
        rayKernels_ = std::move(rayKernels);
    }

    std::unique_ptr<SceneSession> session_;
    RayKernels rayKernels_;  // of the session's device
    std::shared_ptr<PythonFilm> lastFilm_;
};

std::pair<std::shared_ptr<PythonFilm>, bool> merge(const std::vector<std::shared_ptr<PythonFilm>>& films)
{
    if (films.empty()) {
        throw InputError(MessageId::Empty, {"there are no films to merge."});
    }
    std::vector<Film> headers;
    std::vector<std::string> names;
    for (const auto& film : films) {
        headers.push_back(film->film());
        headers.back().pixels.clear();
        headers.back().splats.clear();
        names.push_back("film " + std::to_string(names.size()));
    }
    MergedFilm merged = mergeFilms(headers, names, [&](std::size_t i) { return films[i]->film(); });
    return {std::make_shared<PythonFilm>(std::move(merged.film), std::nullopt), merged.exact};
}

// Radiance as a file that the option --environment takes.
void writeMap(const std::filesystem::path& path,
              const nb::ndarray<const float, nb::shape<-1, -1, 3>, nb::c_contig, nb::device::cpu>& texels)
{
    Image image;
    image.height = static_cast<std::uint32_t>(texels.shape(0));
    image.width = static_cast<std::uint32_t>(texels.shape(1));
    const std::array channels{&image.channels["R"], &image.channels["G"], &image.channels["B"]};
    for (std::size_t i = 0; i < texels.size(); ++i) {
        channels[i % 3]->push_back(texels.data()[i]);
    }
    writeExr(path, image);
}

nb::list devices()
{
    refuseFork();
    nb::list list;
    for (const DeviceDescription& device : listDevices(VulkanInstance())) {
        nb::dict entry;
        entry["name"] = device.name;
        entry["driver"] = device.driver;
        entry["kind"] = device.kind;
        entry["memory"] = device.memory;
        entry["usable"] = device.missing.empty();
        entry["missing"] = device.missing;
        list.append(entry);
    }
    return list;
}

// An object of glim._errors.
nb::object inPython(const char* name, const Message& message)
{
    const auto part = [](const std::string& text) -> nb::object { return text.empty() ? nb::none() : nb::object(nb::str(text.c_str())); };
    return nb::module_::import_("glim._errors")
        .attr(name)(message.sentence, toText(message.id), part(message.file), part(message.place), part(message.value),
                    part(message.expected));
}

void translate(const std::exception_ptr& thrown, void*)
{
    const auto raise = [](const char* name, const Error& error) {
        const nb::object raised = inPython(name, error.message());
        PyErr_SetObject(raised.type().ptr(), raised.ptr());
    };
    try {
        std::rethrow_exception(thrown);
    } catch (const UsageError& error) {
        raise("InputError", error);
    } catch (const InputError& error) {
        raise("InputError", error);
    } catch (const DeviceError& error) {
        raise("DeviceError", error);
    }
}

}  // namespace

NB_MODULE(_glim, module)
{
    nb::register_exception_translator(translate);
    bindFilm(module);
    nb::class_<Wanted>(module, "Wanted").def(nb::init<bool, bool, bool, std::optional<double>>());
    nb::class_<PythonScene>(module, "Scene")
        .def(nb::init<>())
        .def("render", &PythonScene::render, nb::arg("values"), nb::arg("resumed").none(), nb::arg("wanted"), nb::arg("progress").none())
        .def("turntable", &PythonScene::turntable, nb::arg("values"))
        .def_prop_ro("last_film", &PythonScene::lastFilm);
    nb::class_<EditableFile>(module, "EditableFile")
        .def(nb::init<const std::filesystem::path&>(), nb::call_guard<nb::gil_scoped_release>())
        .def("names", &EditableFile::namesAt)
        .def("image_of", &EditableFile::imageOf)
        .def("value", [](const EditableFile& file, const std::string& pointer, const nb::dict& values) {
            std::vector<Edit> edits;
            for (const auto& [name, value] : values) {
                edits.push_back(parseEdit({nb::cast<std::string>(name), valueOf(value)}));
            }
            return file.valueAt(pointer, edits);
        });
    module.def("options", &options);
    module.def("write_map", &writeMap);
    module.def("merge", &merge, nb::arg("films"), nb::call_guard<nb::gil_scoped_release>());
    module.def("devices", &devices);
    module.def("write_file", [](const std::filesystem::path& path, const nb::bytes& content) {
        AtomicFile file(path);
        file.write(content.data(), content.size());
        file.commit();
    });
    module.def("listen", [](nb::callable listener) {
        listenToMessages([listener](Severity severity, const Message& message) {
            const nb::gil_scoped_acquire gil;
            listener(inPython("GlimWarning", message), severity == Severity::Warning);
        });
        // Before the interpreter ends, which no reference to `listener` may outlive.
        nb::module_::import_("atexit").attr("register")(nb::cpp_function([] { listenToMessages(nullptr); }));
    });
}

}  // namespace glim
