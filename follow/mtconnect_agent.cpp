#include "follow/mtconnect_agent.hpp"

#include <curl/curl.h>
#include <fmt/format.h>
#include <libxml/parser.h>

#include <algorithm>
#include <charconv>
#include <new>

#include "base/errors.hpp"
#include "base/time_stamps.hpp"

namespace driftwright::follow {
namespace {

constexpr std::size_t kMostBytes = 16u << 20;  // of an answer
constexpr long kMostRedirections = 5;
constexpr long kBusy = 503;
constexpr const char* kUnavailable = "UNAVAILABLE";

struct FreeDocument {
  void operator()(xmlDoc* document) const { xmlFreeDoc(document); }
};

std::string attribute(xmlNode* element, const char* name) {
  xmlChar* value = xmlGetProp(element, reinterpret_cast<const xmlChar*>(name));
  if (!value) return "";
  std::string text = reinterpret_cast<const char*>(value);
  xmlFree(value);
  return text;
}

std::string content(xmlNode* element) {
  xmlChar* value = xmlNodeGetContent(element);
  if (!value) return "";
  std::string text = reinterpret_cast<const char*>(value);
  xmlFree(value);
  const auto first = text.find_first_not_of(" \t\r\n"), last = text.find_last_not_of(" \t\r\n");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

std::string name_of(const xmlNode* element) {
  return reinterpret_cast<const char*>(element->name);
}

std::uint64_t count_of(xmlNode* element, const char* name) {
  const std::string text = attribute(element, name);
  std::uint64_t value = 0;
  (void)std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

double time_of(xmlNode* element, const char* name) {
  const std::chrono::nanoseconds since_1970 = TimeStamps("", "").read(attribute(element, name));
  return std::chrono::duration<double>(since_1970).count();
}

/// Collects the elements and their children, in document order.
void gather(xmlNode* first, MtconnectStreams& found, std::string& error) {
  for (xmlNode* node = first; node; node = node->next) {
    if (node->type != XML_ELEMENT_NODE) continue;
    if (const std::string id = attribute(node, "dataItemId"); !id.empty()) {
      Observation o{id,
                    attribute(node, "name"),
                    content(node),
                    count_of(node, "sequence"),
                    time_of(node, "timestamp"),
                    name_of(node),
                    attribute(node, "subType")};
      if (o.value == kUnavailable) o.value.clear();
      found.observations.push_back(std::move(o));
      continue;
    }
    if (name_of(node) == "Header") {
      found.instance = attribute(node, "instanceId");
      if (!attribute(node, "nextSequence").empty()) found.created_s = time_of(node, "creationTime");
      found.next = count_of(node, "nextSequence");
      found.last = count_of(node, "lastSequence");
    }
    if (name_of(node) == "Error") {
      found.is_out_of_range = found.is_out_of_range || attribute(node, "errorCode") == "OUT_OF_RANGE";
      if (error.empty()) error = content(node);
    }
    if (name_of(node) == "OutOfRange") found.is_out_of_range = true;  // as in version 2.0 and later
    gather(node->children, found, error);
  }
}

/// Data items below one another, in their order.
void gather(xmlNode* first, std::vector<DataItem>& found, std::string& error) {
  for (xmlNode* node = first; node; node = node->next) {
    if (node->type != XML_ELEMENT_NODE) continue;
    if (name_of(node) == "DataItem")
      found.push_back(
          {attribute(node, "id"), attribute(node, "type"), attribute(node, "subType"), attribute(node, "units")});
    if (name_of(node) == "Error" && error.empty()) error = content(node);
    gather(node->children, found, error);
  }
}

/// A document of a name; else of an error. @throws RangeError  for any other
xmlNode* root_of(const xmlDoc* document, const char* name) {
  xmlNode* root = document ? xmlDocGetRootElement(document) : nullptr;
  if (!root) throw RangeError("its answer is no XML");
  if (name_of(root) != name && name_of(root) != "MTConnectError")
    throw RangeError(fmt::format("its answer is '{}', where {} is required", name_of(root), name));
  return root;
}

std::unique_ptr<xmlDoc, FreeDocument> parsed(const std::string& xml) {
  constexpr int kQuietly = XML_PARSE_NOERROR | XML_PARSE_NOWARNING | XML_PARSE_NONET;
  return std::unique_ptr<xmlDoc, FreeDocument>(
      xmlReadMemory(xml.data(), static_cast<int>(std::min(xml.size(), kMostBytes)), "answer.xml", nullptr, kQuietly));
}

std::size_t append(char* data, std::size_t size, std::size_t n, void* to) {
  auto& text = *static_cast<std::string*>(to);
  if (text.size() + size * n > kMostBytes) return 0;  // ends the transfer
  text.append(data, size * n);
  return size * n;
}

}  // namespace

MtconnectStreams read_mtconnect_streams(const std::string& xml) {
  const auto document = parsed(xml);
  xmlNode* root = root_of(document.get(), "MTConnectStreams");
  MtconnectStreams found;
  std::string error;
  gather(root->children, found, error);
  if (name_of(root) == "MTConnectError" && found.is_out_of_range) return found;
  if (name_of(root) == "MTConnectError") throw RangeError("it answers: " + error);
  return found;
}

std::vector<DataItem> read_mtconnect_devices(const std::string& xml) {
  const auto document = parsed(xml);
  xmlNode* root = root_of(document.get(), "MTConnectDevices");
  std::vector<DataItem> found;
  std::string error;
  gather(root->children, found, error);
  if (name_of(root) == "MTConnectError") throw RangeError("it answers: " + error);
  return found;
}

struct MtconnectAgent::Connection {
  CURL* curl = curl_easy_init();
  // Some agents show people a page unless they are asked for XML.
  curl_slist* headers = curl_slist_append(nullptr, "Accept: application/xml, text/xml;q=0.9");
  char error[CURL_ERROR_SIZE] = "";
  Connection() {
    if (!curl || !headers) throw std::bad_alloc();
  }
  ~Connection() {
    curl_easy_cleanup(curl);
    curl_slist_free_all(headers);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
};

MtconnectAgent::MtconnectAgent(const std::string& url) : url_(url) {
  if (!url.starts_with("http://") && !url.starts_with("https://"))
    throw InputError(
        fmt::format("--mtconnect '{}': the address of an agent is required, such as http://10.0.0.7:5000", url));
  while (url_.ends_with('/')) url_.pop_back();
  connection_ = std::make_unique<Connection>();
}

MtconnectAgent::~MtconnectAgent() = default;

MtconnectStreams MtconnectAgent::current(double most_s) {
  return read_mtconnect_streams(ask("/current", most_s).text);
}

MtconnectStreams MtconnectAgent::sample(std::uint64_t from, double most_s) {
  return read_mtconnect_streams(ask(fmt::format("/sample?from={}&count=1000", from), most_s).text);
}

MtconnectProbe MtconnectAgent::probe(double most_s) {
  const Answer answer = ask("/probe", most_s);
  if (answer.status == kBusy) throw RangeError(fmt::format("its answer to /probe is HTTP status {}", answer.status));
  try {
    return {read_mtconnect_devices(answer.text)};
  } catch (const RangeError& e) {
    return {{}, e.what()};
  }
}

MtconnectAgent::Answer MtconnectAgent::ask(const std::string& request, double most_s) {
  const std::string address = url_ + request;
  CURL* curl = connection_->curl;
  Answer answer;
  connection_->error[0] = '\0';
  curl_easy_setopt(curl, CURLOPT_URL, address.c_str());
  curl_easy_setopt(curl, CURLOPT_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(curl, CURLOPT_FOLLOWLOCATION, 1L);
  curl_easy_setopt(curl, CURLOPT_MAXREDIRS, kMostRedirections);
  curl_easy_setopt(curl, CURLOPT_REDIR_PROTOCOLS_STR, url_.starts_with("https") ? "https" : "http,https");
  curl_easy_setopt(curl, CURLOPT_HTTPHEADER, connection_->headers);
  curl_easy_setopt(curl, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(curl, CURLOPT_FAILONERROR, 0L);  // the agent explains an error in its answer
  curl_easy_setopt(curl, CURLOPT_TIMEOUT_MS, std::max(100L, static_cast<long>(1e3 * most_s)));
  curl_easy_setopt(curl, CURLOPT_ERRORBUFFER, connection_->error);
  curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, &append);
  curl_easy_setopt(curl, CURLOPT_WRITEDATA, &answer.text);
  if (const CURLcode code = curl_easy_perform(curl); code != CURLE_OK)
    throw RangeError(connection_->error[0] != '\0' ? connection_->error : curl_easy_strerror(code));
  curl_easy_getinfo(curl, CURLINFO_RESPONSE_CODE, &answer.status);
  return answer;
}

}  // namespace driftwright::follow
