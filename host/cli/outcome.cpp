#include "host/cli/outcome.hpp"

#include "host/cli/command.hpp"
#include "host/memory.hpp"

#include <new>

namespace glim {
namespace {

std::string sentence(const std::string& text) { return text.ends_with('.') ? text : text + '.'; }

}  // namespace

Outcome outcomeOf(const std::function<ExitCode()>& command)
{
    try {
        return {command(), {}};
    } catch (const UsageError& error) {
        return {ExitCode::Usage, error.what()};
    } catch (const InputError& error) {
        return {ExitCode::BadInput, sentence(error.what())};
    } catch (const DeviceError& error) {
        return {ExitCode::Device, sentence(error.what())};
    } catch (const std::bad_alloc&) {
        return {ExitCode::BadInput, sentence("For this scene and picture " + memorySentence())};
    }
}

}  // namespace glim
