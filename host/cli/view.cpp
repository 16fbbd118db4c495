#include "host/view/view.hpp"
#include "host/cli/commands.hpp"
#include "host/job/look_options.hpp"
#include "host/job/parse.hpp"

#include <memory>

namespace glim {

void addView(CommandLine& line)
{
    auto options = std::make_shared<ViewOptions>();
    Command& command = line.addCommand("view", "Show finished films in a window: layers, differences, values of pixels");
    command.beginGroup("Picture");
    command.addPath("A", "A.exr", "Film, or any other OpenEXR file; read again when it changes", options->film).require();
    command.addPath("B", "B.exr", "A second film of the same size; A is compared with it", options->reference);
    command.beginGroup("Window");
    command.add("--size", "WxH", "Pixels of the window, each side 1 to 65535 [the film's, from 640x480 to the screen's]",
                [options](const OptionValue& value) { options->size = parseSize(value); });
    addLook(command, options->look, "colours", "none");
    command.addText("--device", "D", "Index or part of a name from `glim devices` [the first usable one]", options->device);
    command.addPath("--script", "FILE", "Replay the input that this file lists", options->script);
    command.setFooter(
        "Mouse: drag moves the picture, the wheel zooms, the panel shows the pixel under the mouse, a click prints\n"
        "all its layers.\n"
        "Keys: V next layer, B shows A, B or A - B in turn, + - exposure, T next tone, F fits the window, 1 shows the\n"
        "actual size, L prints the lights as options of glim merge, H shows the panel, a list of keys, or neither, F11\n"
        "fills the screen, Esc quits.\n"
        "Exit codes: 0 done, 1 bad input or no display, 2 usage, 3 device.\n"
        "host/cli/README.md says how each layer is shown.");
    command.onRun([options] {
        view(*options);
        return ExitCode::Done;
    });
}

}  // namespace glim
