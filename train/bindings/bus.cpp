#include "nodes/bus/bus.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/function.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <type_traits>

#include "nodes/bus/network.hpp"
#include "nodes/bus/run_key.hpp"
#include "nodes/stream/stream_cursor.hpp"
#include "train/bindings/arrays.hpp"
#include "train/bindings/bindings.hpp"

namespace rtg::bindings {
namespace {

using Bytes = std::span<const std::uint8_t>;

/// Visitor that puts the fields of a message into a dictionary, arrays as NumPy arrays.
struct ToPython {
  nb::dict out;

  template <class T>
  void scalar(const char* name, const T& x) {
    if constexpr (std::is_integral_v<T>)
      out[name] = static_cast<long>(x);
    else
      out[name] = x;
  }
  void count(const char* name, std::int32_t n) { scalar(name, n); }
  template <class T>
  void array(const char* name, const std::vector<T>& values, std::int32_t) {
    OwnedArray<T> copy(values.size());
    std::copy(values.begin(), values.end(), copy.data.get());
    out[name] = copy.release({values.size()});
  }
  void text(const char* name, const std::string& s) { out[name] = printable(s); }
  void texts(const char* name, const std::vector<std::string>& values, std::int32_t) {
    nb::list all;
    for (const std::string& s : values) all.append(printable(s));
    out[name] = all;
  }

  /// Returns the text with "?" for each byte that could steer a terminal or is not ASCII.
  static std::string printable(std::string s) {
    std::ranges::replace_if(
        s, [](char c) { return c < ' ' || c > '~'; }, '?');
    return s;
  }
};

/// Visitor that takes the fields of a message, but for its header, out of a dictionary. What it
/// does not hold stays 0 or empty; the lengths of arrays follow from the arrays.
struct FromPython {
  nb::dict in;
  std::size_t taken = 0;

  template <class T>
  void scalar(const char* name, T& x) {
    if (!in.contains(name)) return;
    ++taken;
    if (!nb::try_cast(in[name], x))
      throw nb::type_error(
          ("the field '" + std::string(name) + "' cannot hold the value given").c_str());
  }
  void count(const char*, std::int32_t&) {}
  template <class T>
  void array(const char* name, std::vector<T>& values, std::int32_t& n) {
    scalar(name, values);
    n = static_cast<std::int32_t>(values.size());
  }
  void text(const char* name, std::string& s) { scalar(name, s); }
  void texts(const char* name, std::vector<std::string>& values, std::int32_t& n) {
    array(name, values, n);
  }
};

/// A visitor that is told of no header.
template <class Visitor>
struct WithoutHeader : Visitor {
  int header = 3;  // fields of header_t to come

  template <class T>
  void scalar(const char* name, T& x) {
    if (header > 0)
      --header;
    else
      Visitor::scalar(name, x);
  }
};

template <class Msg>
nb::object namespace_of(Msg& message) {
  ToPython fields_of_message;
  fields(fields_of_message, message);
  return nb::module_::import_("types").attr("SimpleNamespace")(**fields_of_message.out);
}

/// Calls `use.operator()<Msg>()` for the type of message that `matches.operator()<Msg>()` selects.
/// Returns whether there is one.
template <class... Msg>
struct Types {
  template <class Matches, class Use>
  static bool find(const Matches& matches, const Use& use) {
    return ((matches.template operator()<Msg>() && (use.template operator()<Msg>(), true)) || ...);
  }
};
using EveryType = rtg_msgs::EveryMessage<Types>;

template <class Use>
void with_type(const std::string& name, const Use& use) {
  const auto is_named = [&]<class Msg>() { return name == Msg::getTypeName(); };
  if (!EveryType::find(is_named, use))
    throw nb::value_error(("no type of message '" + name + "'; legal: those of msgs/").c_str());
}

std::chrono::milliseconds milliseconds(double seconds) {
  return std::chrono::milliseconds(static_cast<long>(seconds * 1000.0));
}

void publish(bus::Bus& bus, const std::string& channel, const std::string& type,
             const nb::kwargs& values) {
  with_type(type, [&]<class Msg>() {
    Msg message{};
    WithoutHeader<FromPython> reader{{nb::borrow<nb::dict>(values)}};
    fields(reader, message);
    if (reader.taken != values.size())
      throw nb::type_error(
          ("not all that was given are fields of " + type + "; legal: those of its .lcm file")
              .c_str());
    bus.publish(channel, std::move(message));
  });
}

void subscribe(bus::Bus& bus, const std::string& channel, const std::string& type,
               const nb::callable& handler) {
  with_type(type, [&]<class Msg>() {
    bus.subscribe<Msg>(channel, [handler](const Msg& message) {
      const nb::gil_scoped_acquire lock;
      Msg copy = message;
      handler(namespace_of(copy));
    });
  });
}

/// Hears all messages of all runs on a bus, unauthenticated.
struct Monitor {
  std::unique_ptr<bus::Network> network;
  bus::Counters counters;

  explicit Monitor(const std::string& url) : network(bus::open_network(url)) {}

  int spin(double timeout, const nb::callable& handler) {
    const nb::gil_scoped_release free;
    return network->spin(milliseconds(timeout), counters, [&](const bus::Datagram& datagram) {
      const nb::gil_scoped_acquire lock;
      nb::object message = nb::none();
      std::string type;
      if (const auto bytes = bus::without_tag(datagram.payload)) read(*bytes, type, message);
      handler(std::string(datagram.channel), datagram.payload.size(), type, message);
      return bus::Network::Verdict::kHandled;
    });
  }

 private:
  static void read(Bytes bytes, std::string& type, nb::object& message) {
    const auto is_this = [&]<class Msg>() {
      return bus::wire::fingerprint_of(bytes) == Msg::getHash();
    };
    EveryType::find(is_this, [&]<class Msg>() {
      Msg decoded{};
      if (bus::decode(bytes, decoded)) return;
      type = Msg::getTypeName();
      message = namespace_of(decoded);
    });
  }
};

void bind_key(nb::module_& module) {
  nb::class_<bus::RunKey>(module, "RunKey",
                          "The secret that the processes of a run share. It authenticates their "
                          "messages.")
      .def_static("random", &bus::RunKey::random, nb::arg("name"),
                  "Draws a key for the run of that name.")
      .def_static("read", &bus::RunKey::read, nb::arg("file"),
                  "Reads a key file. Raises ValueError if it is none, another user's, or open to "
                  "others.")
      .def("write", &bus::RunKey::write, nb::arg("file"),
           "Writes a key file with the mode 0600, in place of another.")
      .def_prop_ro("name", &bus::RunKey::name, "The name of the run.");
  module.def("run_id", &bus::run_id, nb::arg("name"),
             "Returns the field `run` of the messages of the run of that name.");
}

/// The rows of a message are any Python object.
void bind_cursor(nb::module_& module) {
  using Cursor = stream::StreamCursor<nb::object>;
  nb::class_<stream::Acknowledgement>(
      module, "Acknowledgement", "What a consumer of the transition stream says to its sender.")
      .def_ro("cursor", &stream::Acknowledgement::cursor, "Number of the next row to consume.")
      .def_ro("credit", &stream::Acknowledgement::credit,
              "Number of rows accepted from the cursor on; 0: the consumer has all rows.")
      .def_prop_ro(
          "missing",
          [](const stream::Acknowledgement& self) {
            std::vector<std::pair<std::int64_t, std::int64_t>> ranges;
            for (const auto& range : self.missing) ranges.emplace_back(range.begin, range.end);
            return ranges;
          },
          "Ranges of rows to send again: the first one, and the one behind the last.");
  nb::class_<Cursor>(module, "StreamCursor",
                     "The receiving end of the transition stream, without I/O: gets every row once "
                     "and in order from a network that loses, doubles and reorders.")
      .def(nb::init<>())
      .def(
          "on_rows",
          [](Cursor& self, std::int64_t first, std::int64_t end, const nb::object& rows,
             double now) {
            return self.on_rows({first, end}, rows, now);
          },
          nb::arg("first"), nb::arg("end"), nb::arg("rows"), nb::arg("now"),
          "Takes a message with the rows `first` ... `end` - 1. Returns the messages that are next "
          "in order, each with the number of leading rows to skip.")
      .def("on_tail", &Cursor::on_tail, nb::arg("count"), nb::arg("sealed"),
           "Takes what the sender says of the stream: how many rows exist, and whether there will "
           "be "
           "no more.")
      .def(
          "due", &Cursor::due, nb::arg("now"),
          "Returns the next acknowledgement to send at time `now` [s], or None. To be called until "
          "it returns None.")
      .def_prop_ro("cursor", &Cursor::cursor, "Number of the next row in order.")
      .def_prop_ro("complete", &Cursor::complete,
                   "True if the number of rows is final and every row has been returned.");
}

void bind_monitor(nb::module_& module) {
  nb::class_<Monitor>(
      module, "BusMonitor",
      "Hears all messages of all runs on a bus, unauthenticated. Raises RuntimeError "
      "if the network cannot be opened.")
      .def(nb::init<const std::string&>(), nb::arg("url"))
      .def("spin", &Monitor::spin, nb::arg("timeout"), nb::arg("handler"),
           "Waits up to `timeout` s for a message, then calls handler(channel, size [bytes], type, "
           "message) for each that has arrived, at most 1000, and returns their number. Of what is "
           "no message of RTG, the type is \"\" and the message None.")
      .def_prop_ro(
          "warning", [](const Monitor& self) { return self.network->warning(); },
          "A warning for the user about the network; \"\" without one.");
}

}  // namespace

void bind_bus(nb::module_& module) {
  using bus::Bus;
  bind_key(module);
  nb::class_<Bus>(
      module, "Bus",
      "Publishes and receives the messages of one run. What is not of the run, forged, "
      "malformed or not finite is dropped and counted. Raises ValueError for an illegal "
      "URL, RuntimeError if the network cannot be opened.")
      .def(nb::init<const std::string&, bus::RunKey>(), nb::arg("url"), nb::arg("key"))
      .def_static(
          "listener",
          [](const std::string& url, const std::string& run) {
            return std::unique_ptr<Bus>(new Bus(Bus::listener(url, run)));
          },
          nb::arg("url"), nb::arg("run"),
          "Returns a bus that hears what claims to be of the run of that name, unauthenticated, "
          "and "
          "sends nothing.")
      .def("publish", &publish,
           nb::sig("def publish(self, channel: str, type: str, **fields: object) -> None"),
           "Sends a message of the type that msgs/TYPE.lcm describes. Its fields are keyword "
           "arguments, but for the header and the lengths of arrays; those that are not given are "
           "0 or empty. A message that the kernel refuses to send is lost and counted.")
      .def("subscribe", &subscribe, nb::arg("channel"), nb::arg("type"), nb::arg("handler"),
           "Makes spin() call handler(message) for the messages of that channel. Their attributes "
           "are the fields of msgs/TYPE.lcm, those of the header among them, arrays as NumPy "
           "arrays.")
      .def("unsubscribe", &Bus::unsubscribe, "Forgets all handlers.")
      .def(
          "send",
          [](Bus& self, const std::string& channel, const nb::bytes& data) {
            const auto* begin = static_cast<const std::uint8_t*>(data.data());
            self.send(channel, {begin, data.size()});
          },
          nb::arg("channel"), nb::arg("data"),
          "Sends bytes unchanged, as other programs might; for tests.")
      .def(
          "spin",
          [](Bus& self, double timeout) {
            const nb::gil_scoped_release free;
            return self.spin(milliseconds(timeout));
          },
          nb::arg("timeout"),
          "Waits up to `timeout` s for a message, then handles all that have arrived, at most "
          "1000, "
          "and returns their number. A signal ends the wait early. Lets exceptions of handlers "
          "through; the next call goes on with the next message.")
      .def(
          "count", [](Bus& self, const std::string& name) { self.counters().add(name); },
          nb::arg("name"), "Adds 1 to a counter.")
      .def_prop_ro(
          "counters", [](Bus& self) { return self.counters().all(); },
          "Events by name, such as \"bus.forged\", and how often each has happened.")
      .def_prop_ro("run", &Bus::run, "The name of the run.")
      .def_prop_ro("warning", &Bus::warning,
                   "A warning for the user about the network; \"\" without one.");
  bind_monitor(module);
  bind_cursor(module);
}

}  // namespace rtg::bindings
