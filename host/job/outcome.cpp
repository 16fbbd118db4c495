#include "host/job/outcome.hpp"

#include "host/job/option_table.hpp"
#include "host/memory.hpp"

#include <new>

namespace glim {
namespace {

std::string sentence(const std::string& text) { return text.ends_with('.') ? text : text + '.'; }

}  // namespace

std::string describeReason(const std::exception& error)
{
    return dynamic_cast<const std::bad_alloc*>(&error) != nullptr ? memorySentence() : error.what();
}

Outcome runForOutcome(const std::function<ExitCode()>& command)
{
    try {
        return {command(), {}};
    } catch (const UsageError& error) {
        return {ExitCode::Usage, error.what()};
    } catch (const InputError& error) {
        return {ExitCode::BadInput, sentence(error.what())};
    } catch (const DeviceError& error) {
        return {ExitCode::Device, sentence(error.what())};
    } catch (const std::bad_alloc& error) {
        return {ExitCode::BadInput, sentence("For this scene and picture " + describeReason(error))};
    }
}

}  // namespace glim
