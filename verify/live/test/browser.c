#include "browser.h"

#include <curl/curl.h>
#include <jansson.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

struct answer {
	char *text;
	size_t length;
};

static size_t collect(char *part, size_t size, size_t count, void *context)
{
	struct answer *answer = context;
	char *longer = realloc(answer->text, answer->length + size * count + 1);
	if (!longer) return 0;
	memcpy(longer + answer->length, part, size * count);
	answer->text = longer;
	answer->length += size * count;
	longer[answer->length] = 0;
	return size * count;
}

/* Sends a command, whose body it takes over (NULL: none, by `method`); returns its value, or NULL. */
static json_t *command(const char *method, const char *base, const char *path, json_t *body)
{
	char url[200], *text = body ? json_dumps(body, 0) : NULL;
	struct answer answer = {0};
	CURL *curl = curl_easy_init();
	struct curl_slist *headers = curl_slist_append(NULL, "Content-Type: application/json");
	snprintf(url, sizeof url, "%s%s", base, path);
	curl_easy_setopt(curl, CURLOPT_URL, url);
	curl_easy_setopt(curl, CURLOPT_CUSTOMREQUEST, method);
	curl_easy_setopt(curl, CURLOPT_HTTPHEADER, headers);
	curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, collect);
	curl_easy_setopt(curl, CURLOPT_WRITEDATA, &answer);
	curl_easy_setopt(curl, CURLOPT_NOPROXY, "*");
	curl_easy_setopt(curl, CURLOPT_TIMEOUT, 60L);
	if (text) curl_easy_setopt(curl, CURLOPT_POSTFIELDS, text);
	CURLcode code = curl_easy_perform(curl);
	json_t *whole = code == CURLE_OK && answer.text ? json_loads(answer.text, 0, NULL) : NULL;
	json_t *value = json_incref(json_object_get(whole, "value"));
	if (json_object_get(value, "error")) {
		fprintf(stderr, "%s: %s\n", path, json_string_value(json_object_get(value, "message")));
		json_decref(value);
		value = NULL;
	}
	json_decref(whole);
	json_decref(body);
	curl_slist_free_all(headers);
	curl_easy_cleanup(curl);
	free(answer.text);
	free(text);
	return value;
}

/* Starts the driver and waits until it listens. */
static bool start_driver(struct browser *browser, char base[64])
{
	char port[32];
	int number = 20000 + (int)(getpid() % 20000);
	snprintf(port, sizeof port, "--port=%d", number);
	snprintf(base, 64, "http://127.0.0.1:%d", number);
	char *const arguments[] = {"chromedriver", port, "--silent", NULL};
	if (posix_spawnp(&browser->driver, "chromedriver", NULL, NULL, arguments, environ) != 0) return false;
	for (int wait = 0; wait < 100; wait++) {
		json_t *ready = command("GET", base, "/status", NULL);
		json_decref(ready);
		if (ready) return true;
		if (waitpid(browser->driver, NULL, WNOHANG) != 0) {
			browser->driver = 0;
			return false;
		}
		usleep(100000);
	}
	return false;
}

bool browser_open(struct browser *browser, int width, int height, char error[200])
{
	char base[64], size[40];
	*browser = (struct browser){0};
	if (!start_driver(browser, base)) {
		snprintf(error, 200, "chromedriver cannot be started; Debian has it as chromium-driver");
		browser_close(browser);
		return false;
	}
	snprintf(size, sizeof size, "--window-size=%d,%d", width, height);
	json_t *options = json_pack("{s: [s, s, s, s, s]}", "args", "--headless=new", "--no-sandbox",
								"--disable-dev-shm-usage", "--enable-unsafe-swiftshader", size);
	json_t *session = command("POST", base, "/session",
							  json_pack("{s: {s: {s: o, s: {s: s}}}}", "capabilities", "alwaysMatch",
										"goog:chromeOptions", options, "goog:loggingPrefs", "browser", "ALL"));
	const char *name = json_string_value(json_object_get(session, "sessionId"));
	if (name) snprintf(browser->address, sizeof browser->address, "%.60s/session/%.32s", base, name);
	json_decref(session);
	if (*browser->address) return true;
	snprintf(error, 200, "chromium cannot be started; Debian has it as chromium");
	browser_close(browser);
	return false;
}

void browser_close(struct browser *browser)
{
	if (*browser->address) json_decref(command("DELETE", browser->address, "", NULL));
	if (browser->driver > 0) {
		kill(browser->driver, SIGTERM);
		waitpid(browser->driver, NULL, 0);
	}
	*browser = (struct browser){0};
}

bool browser_go(const struct browser *browser, const char *url)
{
	json_t *value = command("POST", browser->address, "/url", json_pack("{s: s}", "url", url));
	json_decref(value);
	return value;
}

char *browser_script(const struct browser *browser, const char *script)
{
	json_t *value =
		command("POST", browser->address, "/execute/sync", json_pack("{s: s, s: []}", "script", script, "args"));
	const char *text = json_string_value(value);
	char *copy = text ? strdup(text) : NULL;
	json_decref(value);
	return copy;
}

char *browser_errors(const struct browser *browser)
{
	char *all = strdup("");
	json_t *list = command("POST", browser->address, "/se/log", json_pack("{s: s}", "type", "browser")), *entry;
	size_t index;
	json_array_foreach(list, index, entry)
	{
		char *longer;
		const char *level = json_string_value(json_object_get(entry, "level"));
		if (!level || strcmp(level, "SEVERE") != 0) continue;
		if (asprintf(&longer, "%s%s\n", all, json_string_value(json_object_get(entry, "message"))) < 0) continue;
		free(all);
		all = longer;
	}
	json_decref(list);
	return all;
}
