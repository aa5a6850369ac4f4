import { defineConfig } from "@playwright/test";

// Debian's Chromium. The example that esbuild has made is served from this machine.
export default defineConfig({
  testDir: "tests",
  testMatch: "*.spec.ts",
  timeout: 120_000,
  workers: 1,
  reporter: [["list"]],
  use: { launchOptions: { executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox"] } },
});
