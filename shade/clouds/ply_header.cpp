#include "shade/clouds/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "shade/clouds/little_bytes.h"

namespace trapeze {
namespace {

constexpr size_t kMostInPlyLine = 1024, kMostPlyLines = 4096, kMostProperties = 4 * kMostChannels;

struct PlyTypeName {
    std::string_view name;
    PlyType type;
    size_t bytes;
    double largest;  ///< of whole numbers that are colours
};
constexpr PlyTypeName kPlyTypes[] = {{"char", PlyType::Int8, 1, 127},
                                     {"int8", PlyType::Int8, 1, 127},
                                     {"uchar", PlyType::Uint8, 1, 255},
                                     {"uint8", PlyType::Uint8, 1, 255},
                                     {"short", PlyType::Int16, 2, 32767},
                                     {"int16", PlyType::Int16, 2, 32767},
                                     {"ushort", PlyType::Uint16, 2, 65535},
                                     {"uint16", PlyType::Uint16, 2, 65535},
                                     {"int", PlyType::Int32, 4, 2147483647},
                                     {"int32", PlyType::Int32, 4, 2147483647},
                                     {"uint", PlyType::Uint32, 4, 4294967295.0},
                                     {"uint32", PlyType::Uint32, 4, 4294967295.0},
                                     {"float", PlyType::Float, 4, 1},
                                     {"float32", PlyType::Float, 4, 1},
                                     {"double", PlyType::Double, 8, 1},
                                     {"float64", PlyType::Double, 8, 1}};

std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    for (size_t at = line.find_first_not_of(" \t\r"); at != std::string_view::npos;) {
        const size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
        words.push_back(line.substr(at, end - at));
        at = line.find_first_not_of(" \t\r", end);
    }
    return words;
}

bool read_count(std::string_view word, uint64_t* count) {
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), *count);
    return error == std::errc() && end == word.data() + word.size();
}

/// Reads the lines of a header.
class HeaderReader {
  public:
    explicit HeaderReader(PlyHeader& header) : header_(header) {}

    /// Takes a line; what is wrong with it, or nothing.
    std::string take(std::string_view line) {
        const std::vector<std::string_view> words = words_of(line);
        if (words.empty() || words[0] == "obj_info") return {};
        if (words[0] == "comment") return comment(words);
        if (words[0] == "format" && words.size() == 3) return format(words[1]);
        if (words[0] == "element" && words.size() == 3) return element(words);
        if (words[0] == "property" && words.size() >= 3) return property(words);
        return fmt::format("its header has a line \"{}\"", line.substr(0, 80));
    }

    /// Finds what the properties are; what is missing, or nothing.
    std::string finish() {
        if (!formatted_) return "it does not say its format";
        if (!found_) return "it has no vertices";
        for (size_t k = 0; k < 3; ++k) {
            header_.position[k] = use(std::string(1, "xyz"[k]));
            header_.normal[k] = use(std::string("n") + "xyz"[k]);
        }
        if (std::ranges::count(header_.position, -1)) return "its vertices have no x, y and z";
        header_.radius = use("radius");
        for (const CloudChannel& channel : told_) add(channel);
        find_channels();
        if (header_.channels.size() > kMostChannels) return "it has too many channels";
        return {};
    }

  private:
    std::string comment(const std::vector<std::string_view>& words) {
        CloudChannel channel;
        if (words.size() == 4 && words[1] == "channel" && channel_type_named(words[2], &channel.type)) {
            channel.name = words[3];
            if (is_channel_name(channel.name) && told_.size() < kMostChannels) told_.push_back(channel);
        }
        return {};
    }

    std::string format(std::string_view word) {
        using Form = PlyHeader::Form;
        formatted_ = true;
        if (word == "ascii")
            header_.form = Form::Ascii;
        else if (word == "binary_little_endian")
            header_.form = Form::LittleEndian;
        else if (word == "binary_big_endian")
            header_.form = Form::BigEndian;
        else
            return fmt::format("its format is \"{}\"", word.substr(0, 80));
        return {};
    }

    std::string element(const std::vector<std::string_view>& words) {
        uint64_t count = 0;
        if (!read_count(words[2], &count)) return fmt::format("it has \"{}\" of an element", words[2]);
        in_vertices_ = words[1] == "vertex" && !found_;
        if (in_vertices_)
            found_ = true, header_.points = count;
        else if (!found_ && count > 0)
            return fmt::format("its first element is \"{}\", and not \"vertex\"", words[1].substr(0, 80));
        return {};
    }

    std::string property(const std::vector<std::string_view>& words) {
        if (!in_vertices_) return {};
        const auto type =
            std::ranges::find_if(kPlyTypes, [&](const PlyTypeName& known) { return known.name == words[1]; });
        if (type == std::end(kPlyTypes))
            return fmt::format("its vertices have a property of type \"{}\"", words[1].substr(0, 80));
        if (header_.properties.size() == kMostProperties) return "its vertices have too many properties";
        header_.properties.push_back({std::string(words[2].substr(0, kMostInPlyLine)), type->type});
        header_.stride += type->bytes;
        used_.push_back(false);
        largest_.push_back(type->largest);
        return {};
    }

    /// The property of a name that nothing else is; -1: none.
    int find(const std::string& name) const {
        for (size_t i = 0; i < header_.properties.size(); ++i)
            if (!used_[i] && header_.properties[i].name == name) return static_cast<int>(i);
        return -1;
    }
    int use(const std::string& name) {
        const int at = find(name);
        if (at >= 0) used_[static_cast<size_t>(at)] = true;
        return at;
    }

    /// Adds a channel, if all its properties are there.
    bool add(const CloudChannel& channel) {
        const std::vector<std::string> names = ply_properties_of(channel);
        if (names.empty() || std::ranges::any_of(names, [&](const auto& name) { return find(name) < 0; }))
            return false;
        for (const std::string& name : names) header_.values.push_back({use(name), 1});
        header_.channels.push_back(channel);
        return true;
    }

    /// Channels that no comment tells of.
    void find_channels() {
        if (find("red") >= 0 && find("green") >= 0 && find("blue") >= 0) {
            for (const char* const name : {"red", "green", "blue"}) {
                const int at = use(name);
                header_.values.push_back({at, largest_[static_cast<size_t>(at)]});
            }
            header_.channels.push_back({"Cs", ChannelType::Color});
        }
        for (size_t i = 0; i < header_.properties.size(); ++i) {
            const std::string name = header_.properties[i].name;
            if (used_[i]) continue;
            const std::string stem = name.size() > 2 ? name.substr(0, name.size() - 2) : "";
            if (name.ends_with("_r") && is_channel_name(stem) && add({stem, ChannelType::Color})) continue;
            if (name.ends_with("_x") && is_channel_name(stem) && add({stem, ChannelType::Vector})) continue;
            if (is_channel_name(name)) add({name, ChannelType::Float});
        }
    }

    PlyHeader& header_;
    std::vector<bool> used_;
    std::vector<double> largest_;
    std::vector<CloudChannel> told_;
    bool formatted_ = false, found_ = false, in_vertices_ = false;
};

}  // namespace

std::vector<std::string> ply_properties_of(const CloudChannel& channel) {
    if (channel.type == ChannelType::Float) return {channel.name};
    if (channel.type == ChannelType::Matrix) return {};
    std::vector<std::string> names;
    for (const char letter : std::string_view(channel.type == ChannelType::Color ? "rgb" : "xyz"))
        names.push_back(channel.name + "_" + letter);
    return names;
}

std::string read_ply_header(std::string_view bytes, PlyHeader* header) {
    ByteReader reader(bytes);
    reader.line(kMostInPlyLine);  // "ply"
    HeaderReader lines(*header);
    for (size_t count = 0; count < kMostPlyLines; ++count) {
        std::string_view line = reader.line(kMostInPlyLine);
        if (reader.ended()) return "its header is cut short";
        if (line.ends_with('\r')) line.remove_suffix(1);
        if (line == "end_header") {
            header->bytes = bytes.size() - reader.left().size();
            return lines.finish();
        }
        if (std::string wrong = lines.take(line); !wrong.empty()) return wrong;
    }
    return "its header has too many lines";
}

}  // namespace trapeze
