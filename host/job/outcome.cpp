#include "host/job/outcome.hpp"

#include "host/job/option_table.hpp"
#include "host/memory.hpp"

#include <new>

namespace glim {
namespace {

Message asSentence(Message message)
{
    message.sentence += message.sentence.ends_with('.') ? "" : ".";
    return message;
}

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
        return {ExitCode::Usage, error.message()};
    } catch (const InputError& error) {
        return {ExitCode::BadInput, asSentence(error.message())};
    } catch (const DeviceError& error) {
        return {ExitCode::Device, asSentence(error.message())};
    } catch (const std::bad_alloc& error) {
        return {ExitCode::BadInput, Message(MessageId::OutOfMemory, {"For this scene and picture ", describeReason(error), "."})};
    }
}

}  // namespace glim
