// Mutants of films. Damaged pixels fail at the film's digest, so half of the mutants are films that glim has read, changed and written.
#include "host/error.hpp"
#include "host/render/build_guide.hpp"
#include "host/render/film_camera.hpp"
#include "host/render/film_file.hpp"
#include "tests/fuzz/mutate_exr.hpp"

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

namespace fs = std::filesystem;

namespace glim::fuzz {
namespace {

// Nothing if the film cannot be read or written.
class FilmMutator {
public:
    FilmMutator()
    {
        std::string folder = "/dev/shm/glim-mutant-XXXXXX";  // anyone can write there
        if (mkdtemp(folder.data()) == nullptr) {
            throw std::runtime_error("no temporary folder: " + folder);
        }
        file_ = fs::path(folder) / "film.exr";
    }
    ~FilmMutator()
    {
        std::error_code ignored;
        fs::remove_all(file_.parent_path(), ignored);
    }
    FilmMutator(const FilmMutator&) = delete;
    FilmMutator& operator=(const FilmMutator&) = delete;

    std::string mutate(const std::string& bytes, Choice& choice) const
    {
        std::ofstream(file_, std::ios::binary) << bytes;
        try {
            StoredFilm stored = readStoredFilm(file_);
            change(stored.film, choice);
            if (stored.checkpoint && choice.oneIn(2)) {
                change(*stored.checkpoint, choice);
            }
            if (stored.checkpoint && stored.checkpoint->guide && choice.oneIn(2)) {
                changeGuide(stored, choice);
            }
            if (stored.checkpoint) {
                writeFilm(file_, stored.film, *stored.checkpoint);
            } else {
                writeFilm(file_, stored.film);
            }
        } catch (const InputError&) {
            return "";
        }
        std::ifstream stream(file_, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }

private:
    template <class Moments>
    static void change(std::vector<Moments>& moments, Choice& choice)
    {
        const std::uint32_t words[] = {0, 1, 0x7f800000, 0xff800000, 0x7fc00000, 0xffffffff, 0x7f7fffff, 1U << 31U, 1024};
        if (!moments.empty()) {
            auto* first = reinterpret_cast<unsigned char*>(&choice.of(moments));
            std::memcpy(first + 4 * choice.below(sizeof(Moments) / 4), &choice.of(words), 4);
        }
    }

    static void change(std::uint32_t& number, Choice& choice)
    {
        const std::uint32_t numbers[] = {0, 1, number + 1, number - 1, 64, 1024, 1U << 31U, 0xffffffffU};
        number = choice.of(numbers);
    }

    static void changeText(Film& film, Choice& choice)
    {
        if (film.camera.empty()) {
            film.camera = describeFilmCamera({}, {film.width, film.height}, glm::dvec3(0.0), 0.5);
        }
        std::string* const texts[] = {&film.arithmetic, &film.device, &film.camera};
        mutateBytes(*choice.of(texts), 8);
    }

    static void change(Film& film, Choice& choice)
    {
        switch (choice.below(8)) {
        case 0: change(film.pixels, choice); break;
        case 1: change(film.splats, choice); break;
        case 2: change(choice.of(film.sampleRanges).first, choice); break;
        case 3: change(choice.of(film.sampleRanges).second, choice); break;
        case 4: film.sampleRanges.emplace_back(choice.below(4096), choice.below(8192)); break;
        case 5: film.complete = !film.complete; break;
        case 6: changeText(film, choice); break;
        default: film.splats.assign(choice.oneIn(2) ? film.pixels.size() : 0, SplatMoments{});
        }
    }

    static void change(Checkpoint& checkpoint, Choice& choice)
    {
        switch (choice.below(8)) {
        case 0: change(checkpoint.page.pixels, choice); break;
        case 1: change(checkpoint.film.pixels, choice); break;
        case 2: change(checkpoint.progress.sample, choice); break;
        case 3: change(checkpoint.progress.pixelsAhead, choice); break;
        case 4: change(checkpoint.progress.lightSample, choice); break;
        case 5: checkpoint.page.splats.assign(choice.oneIn(2) ? checkpoint.film.pixels.size() : 0, SplatMoments{}); break;
        case 6: checkpoint.page.pixels.assign(choice.oneIn(2) ? checkpoint.film.pixels.size() : 0, PixelMoments{}); break;
        default: changeAdaptive(checkpoint, choice);
        }
    }

    static void changeAdaptive(Checkpoint& checkpoint, Choice& choice)
    {
        std::optional<AdaptiveProgress>& progress = checkpoint.progress.adaptive;
        AdaptiveProgress& adaptive = progress ? *progress : progress.emplace();
        change(choice.oneIn(2) ? adaptive.roundEnd : adaptive.chosenBegin, choice);
        for (auto* counts : {&adaptive.chosen, &adaptive.blocksLeft}) {
            counts->resize(checkpoint.film.pixels.size());
            change(*counts, choice);
        }
        checkpoint.common.pixels.resize(checkpoint.film.pixels.size());
    }

    static void changeGuide(StoredFilm& stored, Choice& choice)
    {
        Guide guide = emptyGuide();
        if (const auto& known = stored.checkpoint->guide->guide) {
            guide = *known;
            change(guide.texels, choice);
            guide.digest = digestOf(guide.texels);
        }
        stored.film.identity.settings = "guide=" + guide.digest;
        stored.checkpoint->guide->guide = std::make_shared<const Guide>(std::move(guide));
    }

    fs::path file_;
};

}  // namespace
}  // namespace glim::fuzz

using namespace glim::fuzz;

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t room, unsigned seed)
{
    static const FilmMutator films;
    Choice choice(seed);
    std::string bytes(reinterpret_cast<const char*>(data), size);
    std::string mutant = choice.oneIn(2) ? films.mutate(bytes, choice) : "";
    if (mutant.empty()) {
        mutateExr(bytes, choice);
        mutant = std::move(bytes);
    }
    return handOver(mutant, data, size, room);
}
