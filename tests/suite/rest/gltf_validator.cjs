// Validates a glTF file by Khronos' validator, which NODE_PATH leads to; 77 where it is not installed.
"use strict";

const fs = require("fs");

let validator;
try {
  validator = require("gltf-validator");
} catch {
  console.error("gltf-validator is not installed");
  process.exit(77);
}
const bytes = new Uint8Array(fs.readFileSync(process.argv[2]));
validator.validateBytes(bytes, { maxIssues: 100 }).then((report) => {
  console.log(JSON.stringify(report.issues, null, 1));
  process.exit(report.issues.numErrors + report.issues.numWarnings > 0 ? 1 : 0);
});
