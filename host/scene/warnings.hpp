// Warnings: one line for each kind, however many things that kind concerns.
#pragma once

#include "host/message.hpp"

#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace glim {

class Warnings {
public:
    void add(const Message& message)
    {
        places_.try_emplace(message.sentence, kinds_.size());
        kinds_.push_back({message, {}});
    }
    void add(MessageId id, const std::string& sentence) { add(Message(id, {sentence})); }
    // One more thing that the sentence holds for, and what is the place of it.
    void add(MessageId id, const std::string& sentence, const MessagePart& name)
    {
        if (places_.count(sentence) == 0) {
            add(id, sentence);
        }
        kinds_[places_.at(sentence)].names.push_back(name);
    }
    void add(MessageId id, const std::string& sentence, const std::string& name) { add(id, sentence, part::place(name)); }
    void add(const Warnings& others)
    {
        for (const Kind& kind : others.kinds_) {
            if (kind.names.empty()) {
                add(kind.message);
            }
            for (const MessagePart& name : kind.names) {
                add(kind.message.id, kind.message.sentence, name);
            }
        }
    }

    // "the sentence: first, second, third and 4 more", in the order in which each kind was met first. The names are the place.
    std::vector<Message> messages() const
    {
        std::vector<Message> messages;
        for (const Kind& kind : kinds_) {
            if (kind.names.empty()) {
                messages.push_back(kind.message);
            } else {
                const MessagePart places(MessagePart::Kind::Place, listed(kind.names, &MessagePart::words),
                                         listed(kind.names, &MessagePart::part));
                messages.push_back({kind.message.id, {kind.message.sentence, ": ", places}});
            }
        }
        return messages;
    }

private:
    struct Kind {
        Message message;
        std::vector<MessagePart> names;
    };

    static std::string listed(const std::vector<MessagePart>& names, std::string MessagePart::*member)
    {
        constexpr std::size_t kNamed = 3;
        std::string list;
        for (std::size_t i = 0; i < names.size() && i < kNamed; ++i) {
            list += (i == 0 ? "" : ", ") + names[i].*member;
        }
        return names.size() > kNamed ? list + " and " + std::to_string(names.size() - kNamed) + " more" : list;
    }

    std::vector<Kind> kinds_;
    std::unordered_map<std::string, std::size_t> places_;  // of each sentence in kinds_
};

}  // namespace glim
