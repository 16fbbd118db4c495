#include "host/job/look_options.hpp"

#include "host/image/picture_file.hpp"
#include "host/job/output_file.hpp"
#include "host/job/parse.hpp"
#include "host/message.hpp"

#include <cstdio>

namespace glim {
namespace {

[[noreturn]] void refuse(const OptionTable& table, const std::string& option, const std::string& why)
{
    throw UsageError(option, "\"" + table.textOf(option) + "\": " + why);
}

}  // namespace

void addLook(OptionTable& table, LookOptions& look, const std::string& picture, const std::string& tone)
{
    table.add("--exposure", "EV", "Exposure of " + picture + " in stops, -100 to 100 or auto; not the EXR's [0]",
              [&look](const OptionValue& value) { look.exposure = parseExposure(value); });
    addChoice(table, "--tone", "T", "Tone mapping: none, neutral or agx [" + tone + "]",
              {nameOf(Tone::None), nameOf(Tone::Neutral), nameOf(Tone::Agx)}, [&look](std::size_t i) { look.tone = static_cast<Tone>(i); });
}

void addPictureFiles(OptionTable& table, PictureFiles& files)
{
    table.addPath("--png", "P.png", "Also write an sRGB picture", files.png);
    table.addPath("--image", "P.jpg", "Also write it as .png, .jpg (or .jpeg, quality 95, 4:4:4) or .webp (lossless)", files.image);
}

void resolvePictureFiles(const OptionTable& table, const PictureFiles& files)
{
    for (const char* option : {"--exposure", "--tone"}) {
        if (!files.areGiven() && table.isGiven(option)) {
            refuse(table, option, "is of a picture; expected --png or --image with it");
        }
    }
    if (files.image && !pictureKindOf(*files.image)) {
        refuse(table, "--image", std::string("expected a name that ends in ") + kPictureEndings);
    }
}

void checkPictureTargets(const PictureFiles& files, const std::vector<std::filesystem::path>& inputs)
{
    if (files.png) {
        checkTarget(*files.png, ".png", inputs);
    }
    if (files.image) {
        checkTarget(*files.image, "", inputs);
    }
}

Look chooseLook(const LookOptions& options, const Film& film)
{
    Look look{options.exposure.value_or(0.0), options.tone.value_or(Tone::None)};
    if (!options.exposure) {
        look.exposure = chooseExposure(film, aovOf(film));
        char stops[32];
        std::snprintf(stops, sizeof stops, "%+.2f", look.exposure);
        say(std::string("--exposure auto is ") + stops + " stops, which show the log-average luminance as .18");
    }
    return look;
}

void writePictures(const PictureFiles& files, const Film& film, const Look& look)
{
    for (const auto& file : {files.png, files.image}) {
        if (file) {
            writeFilmPicture(*file, film, aovOf(film), look);
        }
    }
}

}  // namespace glim
