#include <httplib.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include "pipeline/preview/httplib/brief_connection.h"
#include "pipeline/preview/web_server.h"

namespace trapeze {
namespace {

constexpr const char* kHost = "127.0.0.1";
/// Requests are short, and have no body.
constexpr size_t kMostBody = 1024;
/// Each page keeps one answer waiting while it asks for others.
constexpr size_t kThreads = 8;

/// The library's server, but that nobody can hold up its end.
class BriefServer final : public httplib::Server {
  public:
    /// From now on nothing is waited for longer than for a moment.
    void hurry() { end_ = std::chrono::steady_clock::now() + BriefConnection::kPatience; }

  private:
    bool process_and_close_socket(socket_t socket) override {
        bool is_closed = false, is_answered = false;
        BriefConnection connection(socket, end_);
        try {
            is_answered = process_request(connection, true, is_closed, nullptr);
        } catch (const std::exception&) {}  // no memory for what is asked: the browser asks again
        shutdown(socket, SHUT_RDWR);
        close(socket);
        return is_answered;
    }

    EndOfWaiting end_{std::chrono::steady_clock::time_point::max()};
};

class HttplibServer final : public WebServer {
  public:
    explicit HttplibServer(AnswerWebRequest answer) : answer_(std::move(answer)) {
        server_.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
        // The library's own options would let two servers have one port.
        server_.set_socket_options([](socket_t file) {
            const int on = 1;
            setsockopt(file, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
        });
        server_.set_payload_max_length(kMostBody);
        server_.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
            respond(request, response);
            return httplib::Server::HandlerResponse::Handled;
        });
    }

    ~HttplibServer() override {
        server_.hurry();
        server_.stop();
        if (thread_.joinable()) thread_.join();
    }

    bool listen(int first_port, int last_port) {
        for (port_ = first_port; port_ <= last_port; ++port_) {
            if (!server_.bind_to_port(kHost, port_)) continue;
            thread_ = std::thread([this] { server_.listen_after_bind(); });
            // stop() does nothing before that.
            while (!server_.is_running()) std::this_thread::yield();
            return true;
        }
        return false;
    }

    int port() const override { return port_; }

  private:
    void respond(const httplib::Request& request, httplib::Response& response) const {
        response.set_header("Cache-Control", "no-store");
        response.set_header("X-Content-Type-Options", "nosniff");
        response.set_header("Content-Security-Policy",
                            "default-src 'self'; img-src data:; base-uri 'none'; form-action 'none'; "
                            "frame-ancestors 'none'");
        response.set_header("Cross-Origin-Resource-Policy", "same-origin");
        response.set_header("Cross-Origin-Opener-Policy", "same-origin");
        response.set_header("Connection", "close");
        if (request.method != "GET" && request.method != "HEAD") {
            response.status = 405;
            return;
        }
        WebRequest asked{request.path,
                         request.get_header_value("Host"),
                         {},
                         request.get_header_value("Sec-Fetch-Site"),
                         request.get_header_value("Origin")};
        for (const auto& [name, value] : request.params) asked.parameters.emplace(name, value);
        const WebAnswer answer = answer_(asked);
        response.status = answer.status;
        response.set_content(answer.body, answer.type);
    }

    const AnswerWebRequest answer_;
    BriefServer server_;
    std::thread thread_;
    int port_ = 0;
};

class HttplibLibrary final : public WebLibrary {
  public:
    std::unique_ptr<WebServer> serve(int first_port, int last_port, AnswerWebRequest answer,
                                     std::string* problem) const override {
        auto server = std::make_unique<HttplibServer>(std::move(answer));
        if (server->listen(first_port, last_port)) return server;
        *problem = first_port == last_port ? "port " + std::to_string(first_port) + " is taken"
                                           : "ports " + std::to_string(first_port) + " to " +
                                                 std::to_string(last_port) + " are taken";
        return {};
    }
};

constexpr HttplibLibrary kLibrary;

}  // namespace
}  // namespace trapeze

const trapeze::ModuleEntry trapeze_web_module = {TRAPEZE_VERSION,
                                                 static_cast<const trapeze::WebLibrary*>(&trapeze::kLibrary)};
