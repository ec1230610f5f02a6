#include "pipeline/checkpoint/run_record.h"

#include <nlohmann/json.hpp>

#include "core/files/sha256.h"

namespace trapeze {

using json = nlohmann::ordered_json;

std::vector<InputFile> hashed_inputs(const std::set<std::string>& names) {
    std::vector<InputFile> inputs;
    for (const std::string& name : names) {
        const auto hash = hash_of_file(name);
        inputs.push_back({name, hash ? hash->bytes : 0, hash ? hash->sha256 : std::string()});
    }
    return inputs;
}

json to_json(const std::vector<RecordedOption>& options) {
    json all = json::object();
    for (const RecordedOption& option : options)
        all[option.name] = option.values.empty()       ? json(true)
                           : option.values.size() == 1 ? json(option.values.front())
                                                       : json(option.values);
    return all;
}

json to_json(const std::vector<InputFile>& inputs) {
    json all = json::array();
    for (const InputFile& input : inputs)
        all.push_back({{"name", input.name},
                       {"bytes", input.bytes},
                       {"sha256", input.sha256.empty() ? json() : json(input.sha256)}});
    return all;
}

}  // namespace trapeze
