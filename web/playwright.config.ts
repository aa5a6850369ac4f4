import { defineConfig } from "@playwright/test";

// Debian's Chromium, which draws in software where there is no graphics processor.
export default defineConfig({
  testDir: "tests",
  timeout: 120_000,
  workers: 1,
  // On a busy machine that draws in software now and then an event comes late; what passes then is called flaky.
  retries: process.env.CI ? 1 : 0,
  reporter: [["list"]],
  use: {
    viewport: { width: 1280, height: 800 },
    launchOptions: {
      executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
      args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
    },
  },
});
