#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/shell_word.h"
#include "pipeline/farm/farm_job.h"
#include "pipeline/frame/json_text.h"

namespace trapeze {
namespace {

using json = nlohmann::ordered_json;

/// A step's command runs where the host's session is, and goes from there to the job's folder.
json action(const FarmJob& job, const std::string& script, const std::vector<std::string>& arguments) {
    json words = {"-c", "cd \"$0\" && exec bash " + shell_word(job.path(script)) + " \"$@\"",
                  "{{Param.Folder}}"};
    for (const std::string& argument : arguments) words.push_back("{{Task.Param." + argument + "}}");
    return {{"onRun",
             {{"command", "bash"},
              {"args", std::move(words)},
              {"cancelation", {{"mode", "NOTIFY_THEN_TERMINATE"}, {"notifyPeriodInSeconds", 120}}}}}};
}

json integers(const char* name, const json& range) {
    return {{"name", name}, {"type", "INT"}, {"range", range}};
}

/// "1-3,7", of numbers that rise.
std::string ranges_of(const std::vector<int>& numbers) {
    std::string text;
    for (size_t i = 0; i < numbers.size();) {
        size_t end = i;
        while (end + 1 < numbers.size() && numbers[end + 1] == numbers[end] + 1) ++end;
        text += (text.empty() ? "" : ",") +
                (end > i ? fmt::format("{}-{}", numbers[i], numbers[end]) : fmt::format("{}", numbers[i]));
        i = end + 1;
    }
    return text;
}

}  // namespace

std::vector<FarmFile> open_job_files(const FarmJob& job, const std::string& here) {
    const bool in_tiles = job.tile_count() > 1;
    json parameters = json::array();
    parameters.push_back({{"name", "Folder"},
                          {"type", "PATH"},
                          {"objectType", "DIRECTORY"},
                          {"dataFlow", "INOUT"},
                          {"description", "the folder in which the job was made"},
                          {"default", here}});
    json tasks = json::array({integers("Frame", ranges_of(job.frames))});
    std::vector<std::string> arguments{"Frame"};
    if (in_tiles) {
        tasks.push_back(integers("Tile", fmt::format("1-{}", job.tile_count())));
        arguments.emplace_back("Tile");
    }
    json render{{"name", "Render"},
                {"parameterSpace", {{"taskParameterDefinitions", std::move(tasks)}}},
                {"script", {{"actions", action(job, "render", arguments)}}}};
    json steps = json::array({std::move(render)});
    if (in_tiles)
        steps.push_back(
            {{"name", "Merge"},
             {"dependencies", json::array({{{"dependsOn", "Render"}}})},
             {"parameterSpace",
              {{"taskParameterDefinitions", json::array({integers("Frame", ranges_of(job.frames))})}}},
             {"script", {{"actions", action(job, "merge", {"Frame"})}}}});
    const json whole{{"specificationVersion", "jobtemplate-2023-09"},
                     {"name", job.name},
                     {"parameterDefinitions", std::move(parameters)},
                     {"steps", std::move(steps)}};
    return {{job.path("template.json"), json_text(whole) + "\n", false}};
}

}  // namespace trapeze
