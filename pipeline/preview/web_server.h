/// A server of web pages for this machine alone: cpp-httplib, in the module "web".
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "core/files/module.h"

namespace trapeze {

/// What a browser asks for.
struct WebRequest {
    std::string path;
    std::string host;  ///< as the browser calls the server
    std::map<std::string, std::string> parameters;
    /// What the browser says of the page that asks: headers Sec-Fetch-Site and Origin; empty where it says
    /// nothing.
    std::string site = {}, origin = {};
};

struct WebAnswer {
    int status = 200;
    std::string type = "text/plain; charset=utf-8";
    std::string body;
};

/// Called from several threads at a time.
using AnswerWebRequest = std::function<WebAnswer(const WebRequest&)>;

/// Serves as long as it lives. Its end waits for answers that are being made, and a second at most for
/// browsers that take them.
class WebServer {
  public:
    virtual ~WebServer() = default;
    virtual int port() const = 0;
};

/// What the module offers: the program itself is not linked with cpp-httplib.
class WebLibrary {
  public:
    /// Serves at 127.0.0.1, at the first free port of these. Null, with *problem set, where none is.
    virtual std::unique_ptr<WebServer> serve(int first_port, int last_port, AnswerWebRequest answer,
                                             std::string* problem) const = 0;

  protected:
    ~WebLibrary() = default;
};

/// The library, from the module "web"; null, with *problem set, where that cannot be opened.
const WebLibrary* web_library(std::string* problem);

}  // namespace trapeze

extern "C" {
[[gnu::visibility("default")]] extern const trapeze::ModuleEntry trapeze_web_module;
}
