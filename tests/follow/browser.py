"""A headless Chromium that tests control by its DevTools protocol over two pipes, without a library or a port."""
import base64
import itertools
import json
import os
import shutil
import subprocess
import tempfile
import time


class Browser:
    def __init__(self):
        self.folder = tempfile.mkdtemp(prefix="driftwright_browser-")
        to_browser, self.to = os.pipe()
        self.back, from_browser = os.pipe()

        def as_three_and_four():  # the file descriptors that Chromium reads
            os.dup2(to_browser, 30)
            os.dup2(from_browser, 31)
            os.dup2(30, 3)
            os.dup2(31, 4)

        self.process = subprocess.Popen(
            [found(), "--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--use-gl=angle", "--use-angle=swiftshader",
             "--enable-unsafe-swiftshader", "--hide-scrollbars", f"--user-data-dir={self.folder}", "--remote-debugging-pipe", "about:blank"],
            close_fds=False, preexec_fn=as_three_and_four, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_browser)
        os.close(from_browser)
        self.numbers, self.rest = itertools.count(1), b""

    def ask(self, method, session=None, **parameters):
        number = next(self.numbers)
        message = {"id": number, "method": method, "params": parameters, **({"sessionId": session} if session else {})}
        os.write(self.to, json.dumps(message).encode() + b"\0")
        while True:
            while b"\0" not in self.rest:
                part = os.read(self.back, 1 << 20)
                if not part:
                    raise RuntimeError("the browser has ended")
                self.rest += part
            text, self.rest = self.rest.split(b"\0", 1)
            answer = json.loads(text)
            if answer.get("id") == number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]

    def open(self, url, width=1200, height=1500):
        target = self.ask("Target.createTarget", url="about:blank")["targetId"]
        page = Page(self, target, self.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"])
        self.ask("Emulation.setDeviceMetricsOverride", page.session, width=width, height=height, deviceScaleFactor=1, mobile=False)
        self.ask("Page.bringToFront", page.session)  # a page in the background draws nothing
        self.ask("Page.navigate", page.session, url=url)
        return page

    def close(self):
        self.process.kill()
        self.process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)


class Page:
    def __init__(self, browser, target, session):
        self.browser, self.target, self.session = browser, target, session

    def close(self):
        self.browser.ask("Target.closeTarget", targetId=self.target)

    def value(self, script):
        """The value of a JavaScript expression."""
        result = self.browser.ask("Runtime.evaluate", self.session, expression=script, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise RuntimeError(f"{script}: {result['exceptionDetails']}")
        return result["result"].get("value")

    def wait(self, script, seconds=60):
        """Waits until the expression is true."""
        end = time.monotonic() + seconds
        while True:
            try:
                value = self.value(script)
            except RuntimeError as error:  # a page that is not loaded yet
                value = None
                said = error
            else:
                said = value
            if value:
                return value
            if time.monotonic() > end:
                raise AssertionError(f"in {seconds} s never: {script}; {said}")
            time.sleep(0.1)

    def screenshot(self, path):
        data = self.browser.ask("Page.captureScreenshot", self.session, format="png")["data"]
        with open(path, "wb") as file:
            file.write(base64.b64decode(data))


def found():
    return shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
