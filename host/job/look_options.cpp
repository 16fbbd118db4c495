#include "host/job/look_options.hpp"

#include "host/image/picture_file.hpp"
#include "host/job/output_file.hpp"
#include "host/job/parse.hpp"
#include "host/message.hpp"
#include "host/text.hpp"

#include <cstdio>
#include <utility>

namespace glim {
void addLook(OptionTable& table, LookOptions& look, const std::string& picture, const std::string& tone)
{
    table.add("--exposure", "EV", "Exposure of " + picture + " in stops, -100 to 100 or auto; not the EXR's [0]",
              [&look](const OptionValue& value) { look.exposure = parseExposure(value); });
    addChoice(table, "--tone", "T", "Tone mapping: none, neutral or agx [" + tone + "]",
              {getName(Tone::None), getName(Tone::Neutral), getName(Tone::Agx)},
              [&look](std::size_t i) { look.tone = static_cast<Tone>(i); });
}

void addPictureFiles(OptionTable& table, PictureFiles& files)
{
    table.addEach("--png,--image", "P.png", "Also write an sRGB picture: .png, .jpg (quality 95, 4:4:4) or .webp (lossless)",
                  [&files](const OptionValue& value) { files.emplace_back(value.text()); });
}

void resolveOutput(std::optional<std::filesystem::path>& output, PictureFiles& files)
{
    if (output && getPictureKind(*output)) {
        files.insert(files.begin(), *std::exchange(output, std::nullopt));
    } else if (output && lowerCase(output->extension().string()) != ".exr") {
        throw UsageError(MessageId::UnknownFormat,
                         {part::place("--output"), ": ", part::quoted(*output), ": expected ",
                          part::expected(std::string("a name that ends in .exr, or a picture's, which ends in ") + kPictureEndings)});
    }
}

void resolvePictureFiles(const OptionTable& table, const PictureFiles& files)
{
    for (const char* option : {"--exposure", "--tone"}) {
        if (files.empty() && table.isGiven(option) && !table.isByFile(option)) {
            throw UsageError(MessageId::Requires, {part::place(option), ": ", part::quoted(table.toText(option)),
                                                   ": is of a picture; expected ", part::expected("--image"), " with it"});
        }
    }
    for (const std::filesystem::path& file : files) {
        if (!getPictureKind(file)) {
            throw UsageError(MessageId::UnknownFormat, {part::place("--image"), ": ", part::quoted(file), ": expected ",
                                                        part::expected(std::string("a name that ends in ") + kPictureEndings)});
        }
    }
}

void checkPictureTargets(const PictureFiles& files, const std::vector<std::filesystem::path>& inputs)
{
    for (const std::filesystem::path& file : files) {
        checkTarget(file, "", inputs);
    }
}

Look chooseLook(const LookOptions& options, const Film& film)
{
    Look look{options.exposure.value_or(0.0), options.tone.value_or(Tone::None)};
    if (!options.exposure) {
        look.exposure = chooseExposure(film, getAov(film));
        char stops[32];
        std::snprintf(stops, sizeof stops, "%+.2f", look.exposure);
        say(MessageId::ExposureChosen,
            {part::place("--exposure"), " auto is ", part::value(stops), " stops, which show the log-average luminance as .18"});
    }
    return look;
}

void writePictures(const PictureFiles& files, const Film& film, const Look& look)
{
    for (const std::filesystem::path& file : files) {
        writeFilmPicture(file, film, getAov(film), look);
    }
}

}  // namespace glim
