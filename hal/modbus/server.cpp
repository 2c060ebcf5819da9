#include "hal/modbus/server.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <list>

#include "hal/bus_budget.hpp"
#include "hal/modbus/connection.hpp"
#include "hal/modbus/serial_line.hpp"

namespace stiction::hal {

// What the thread serves until it is told to stop.
class ModbusServer::Endpoint {
 public:
  Endpoint(ModbusServer& server, const ModbusServerConfig& config, RegisterValues values, ModbusTransport transport)
      : server_(server),
        responder_(transport, server.map_, std::move(values), config.motion_allowed, config.unit, *server.taker_) {}
  virtual ~Endpoint() = default;
  Endpoint(const Endpoint&) = delete;
  Endpoint& operator=(const Endpoint&) = delete;

  virtual void serve() = 0;

 protected:
  // Each is written by the server's thread alone.
  static void count(std::atomic<std::uint64_t>& counter, int by = 1) {
    counter.fetch_add(static_cast<std::uint64_t>(by), std::memory_order_relaxed);
  }

  ModbusServer& server_;
  ModbusResponder responder_;
};

namespace {

class Socket {
 public:
  explicit Socket(int descriptor) : descriptor_(descriptor) {}
  ~Socket() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  int get() const { return descriptor_; }

 private:
  int descriptor_;
};

struct AddressList {
  addrinfo* first = nullptr;
  AddressList() = default;
  ~AddressList() {
    if (first != nullptr) ::freeaddrinfo(first);
  }
  AddressList(const AddressList&) = delete;
  AddressList& operator=(const AddressList&) = delete;
};

const char* advice_for(int error) {
  switch (error) {
    case EADDRINUSE:
      return "a different programme listens there; choose a different port";
    case EACCES:
      return "ports below 1024 need CAP_NET_BIND_SERVICE; choose a higher one";
    case EADDRNOTAVAIL:
      return "no interface of this computer has that address";
    default:
      return "choose a different address";
  }
}

int listen_on(const std::string& address) {
  const auto [host, port] = host_and_port(address);
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  AddressList found;
  if (const int error = ::getaddrinfo(host.c_str(), port.c_str(), &hints, &found.first); error != 0)
    throw ModbusError(fmt::format("{}: {}; expected an address of this computer, such as 127.0.0.1:502", address,
                                  gai_strerror(error)));
  const int descriptor = ::socket(found.first->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  const int on = 1;
  if (descriptor >= 0) ::setsockopt(descriptor, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (descriptor < 0 || ::bind(descriptor, found.first->ai_addr, found.first->ai_addrlen) != 0 ||
      ::listen(descriptor, SOMAXCONN) != 0) {
    const int error = errno;
    if (descriptor >= 0) ::close(descriptor);
    throw ModbusError(fmt::format("{}: cannot listen: {}; {}", address, std::strerror(error), advice_for(error)));
  }
  return descriptor;
}

int port_of(int descriptor) {
  sockaddr_storage storage{};
  socklen_t size = sizeof storage;
  std::array<char, 16> port{};
  if (::getsockname(descriptor, reinterpret_cast<sockaddr*>(&storage), &size) != 0 ||
      ::getnameinfo(reinterpret_cast<sockaddr*>(&storage), size, nullptr, 0, port.data(), port.size(),
                    NI_NUMERICSERV) != 0)
    return 0;
  return std::atoi(port.data());
}

}  // namespace

class ModbusServer::TcpEndpoint : public Endpoint {
 public:
  TcpEndpoint(ModbusServer& server, const ModbusServerConfig& config, RegisterValues values)
      : Endpoint(server, config, std::move(values), ModbusTransport::tcp),
        listener_(listen_on(config.address)),
        most_clients_(static_cast<std::size_t>(std::max(config.most_clients, 1))) {
    server_.port_ = port_of(listener_.get());
  }

  void serve() override {
    std::vector<pollfd> polled;
    while (true) {
      polled = {{server_.stop_, POLLIN, 0}, {listener_.get(), POLLIN, 0}};
      for (const Client& client : clients_) polled.push_back({client.socket.get(), events_of(client), 0});
      const bool waiting = std::any_of(clients_.begin(), clients_.end(),
                                       [](const Client& client) { return client.connection.is_waiting(); });
      if (::poll(polled.data(), polled.size(), waiting ? put_off_ms : -1) < 0) continue;  // a signal
      if (polled[0].revents != 0) return;
      auto client = clients_.begin();
      for (std::size_t i = 2; i < polled.size(); ++i) {
        const auto next = std::next(client);
        count(server_.requests_, client->connection.resume());
        const bool served = polled[i].revents != 0 || !client->connection.unsent().empty();
        const bool gone = (polled[i].revents & (POLLERR | POLLHUP)) != 0 && client->connection.is_waiting();
        if (gone || (served && !serve_client(*client))) {
          server_.taker_->forget(client->connection.client());
          clients_.erase(client);
        }
        client = next;
      }
      if (polled[1].revents != 0) accept_client();
    }
  }

 private:
  struct Client {
    Socket socket;
    ModbusConnection connection;
    Client(int descriptor, ModbusResponder& responder, std::uint16_t number)
        : socket(descriptor), connection(responder, number) {}
  };

  // Of the connections in their order, so that a number comes again late, and never of one that is there.
  std::uint16_t free_number() {
    const auto taken = [this](std::uint16_t number) {
      return number == 0 || std::any_of(clients_.begin(), clients_.end(), [number](const Client& client) {
               return client.connection.client() == number;
             });
    };
    do {
      ++last_number_;
    } while (taken(last_number_));
    return last_number_;
  }

  static short events_of(const Client& client) {
    const int in = client.connection.is_full() ? 0 : POLLIN;
    const int out = client.connection.unsent().empty() ? 0 : POLLOUT;
    return static_cast<short>(in | out);
  }

  void accept_client() {
    const int descriptor = ::accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (descriptor < 0) return;
    if (clients_.size() >= most_clients_) {
      ::close(descriptor);
      count(server_.dropped_);
      return;
    }
    const auto set = [descriptor](int level, int option, int value) {
      ::setsockopt(descriptor, level, option, &value, sizeof value);
    };
    set(IPPROTO_TCP, TCP_NODELAY, 1);
    // A client whose computer is gone gives its place back within a minute.
    set(SOL_SOCKET, SO_KEEPALIVE, 1);
    set(IPPROTO_TCP, TCP_KEEPIDLE, 30);
    set(IPPROTO_TCP, TCP_KEEPINTVL, 10);
    set(IPPROTO_TCP, TCP_KEEPCNT, 3);
    clients_.emplace_back(descriptor, responder_, free_number());
    count(server_.connections_);
  }

  // False: the connection has ended.
  bool serve_client(Client& client) {
    if (!client.connection.is_full() && !receive(client)) return false;
    if (!send(client)) return false;
    if (client.connection.is_lost()) {
      count(server_.dropped_);
      return false;
    }
    return true;
  }
  bool receive(Client& client) {
    std::array<std::uint8_t, 2048> bytes;
    const ssize_t got = ::recv(client.socket.get(), bytes.data(), bytes.size(), 0);
    if (got == 0) return false;
    if (got < 0) return errno == EAGAIN || errno == EINTR;
    answer(client, std::span(bytes).first(static_cast<std::size_t>(got)));
    return true;
  }
  void answer(Client& client, std::span<const std::uint8_t> bytes) {
    count(server_.requests_, client.connection.receive(bytes));
  }
  bool send(Client& client) {
    while (!client.connection.unsent().empty()) {
      const auto bytes = client.connection.unsent();
      const ssize_t sent = ::send(client.socket.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent < 0) return errno == EAGAIN || errno == EINTR;
      client.connection.sent(static_cast<std::size_t>(sent));
      answer(client, {});  // what waited until there was room
    }
    return true;
  }

  Socket listener_;
  std::size_t most_clients_;
  static constexpr int put_off_ms = 5;  // from one look at what was put off to the next
  std::list<Client> clients_;
  std::uint16_t last_number_ = 0;
};

class ModbusServer::SerialEndpoint : public Endpoint {
 public:
  SerialEndpoint(ModbusServer& server, const ModbusServerConfig& config, RegisterValues values)
      : Endpoint(server, config, std::move(values), ModbusTransport::rtu),
        line_(open_serial_line(config.address, config.baud_rate, config.unit)) {}

  void serve() override {
    const int line = modbus_get_socket(line_.get());
    ::fcntl(line, F_SETFL, ::fcntl(line, F_GETFL) | O_NONBLOCK);
    while (true) {
      std::array<pollfd, 2> polled{{{server_.stop_, POLLIN, 0}, {line, POLLIN, 0}}};
      const int ready = ::poll(polled.data(), polled.size(), in_.empty() && ticket_ == 0 ? -1 : silence_ms);
      if (ready < 0) continue;
      if (polled[0].revents != 0) return;
      if (ready == 0) {
        if (ticket_ != 0)
          answer_late(line);
        else
          hear_silence(line);
        continue;
      }
      ticket_ = 0;  // its master has given up waiting
      std::array<std::uint8_t, longest_modbus_request> bytes;
      const ssize_t got = ::read(line, bytes.data(), bytes.size());
      if (got > 0)
        in_.insert(in_.end(), bytes.begin(), bytes.begin() + got);
      else if (::poll(polled.data(), 1, lost_line_ms) > 0)  // the other end hung up; it may come back
        return;
      silent_ms_ = 0;
      if (in_.size() > longest_modbus_request) forget();
    }
  }

 private:
  // A request ends with a silence of 1.75 ms. Drivers hand bytes on in pieces, so that what does not make a request yet
  // may only be late.
  static constexpr int silence_ms = 2, patience_ms = 50, lost_line_ms = 100;

  void hear_silence(int line) {
    silent_ms_ += silence_ms;
    if (in_.size() >= 4 && is_whole()) {
      const auto answer = responder_.answer(in_);
      ticket_ = responder_.put_off();
      if (ticket_ != 0) waiting_ = in_;
      in_.clear();
      send(line, answer);
      if (!answer.empty()) count(server_.requests_);
    } else if (silent_ms_ >= patience_ms) {
      forget();
    }
  }
  void answer_late(int line) {
    const auto answer = responder_.late_answer(waiting_, ticket_);
    if (!answer) return;
    ticket_ = 0;
    send(line, *answer);
    count(server_.requests_);
  }
  bool is_whole() const {
    const std::uint16_t crc = modbus_crc(std::span(in_).first(in_.size() - 2));
    return in_[in_.size() - 2] == (crc & 0xff) && in_.back() == crc >> 8;
  }
  void forget() {
    in_.clear();
    count(server_.dropped_);
  }
  static void send(int line, std::span<const std::uint8_t> bytes) {
    for (int tries = 0; !bytes.empty() && tries < patience_ms; ++tries) {
      const ssize_t sent = ::write(line, bytes.data(), bytes.size());
      if (sent > 0) bytes = bytes.subspan(static_cast<std::size_t>(sent));
      pollfd writable{line, POLLOUT, 0};
      if (!bytes.empty()) ::poll(&writable, 1, 1);
    }
  }

  ModbusContext line_;
  std::vector<std::uint8_t> in_;
  std::vector<std::uint8_t> waiting_;  // the request that was put off
  std::uint64_t ticket_ = 0;
  int silent_ms_ = 0;
};

ModbusServer::ModbusServer(RegisterMap map, const ModbusServerConfig& config, RegisterValues values, WriteTaker* taker)
    : map_(std::move(map)), taker_(taker == nullptr ? &queue_taker_ : taker) {
  if (is_serial_device(config.address))
    endpoint_ = std::make_unique<SerialEndpoint>(*this, config, std::move(values));
  else
    endpoint_ = std::make_unique<TcpEndpoint>(*this, config, std::move(values));
  stop_ = ::eventfd(0, EFD_CLOEXEC);
  thread_ = std::thread([this] { endpoint_->serve(); });
}

ModbusServer::~ModbusServer() {
  ::eventfd_write(stop_, 1);
  thread_.join();
  ::close(stop_);
}

ModbusServerCounts ModbusServer::counts() const {
  return {requests_.load(std::memory_order_relaxed), connections_.load(std::memory_order_relaxed),
          dropped_.load(std::memory_order_relaxed)};
}

}  // namespace stiction::hal
