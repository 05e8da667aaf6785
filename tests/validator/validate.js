// The Khronos glTF validator over many files in one process.
// usage: node validate.js VALIDATOR_MODULE < LIST, one path a line
// Prints one JSON object: path -> [{code, message, pointer}], errors only.
const fs = require('fs');
const path = require('path');
const validator = require(path.resolve(process.argv[2]));

async function errorsOf(file) {
    const readBeside = async (uri) =>
        new Uint8Array(await fs.promises.readFile(path.join(path.dirname(file), decodeURIComponent(uri))));
    try {
        const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), {
            uri: path.basename(file),
            maxIssues: 1000,
            externalResourceFunction: readBeside,
        });
        return report.issues.messages.filter((issue) => issue.severity === 0)
            .map(({code, message, pointer}) => ({code, message, pointer: pointer ?? ''}));
    } catch (fault) {
        return [{code: 'UNREADABLE', message: String(fault), pointer: ''}];
    }
}

async function main() {
    const files = fs.readFileSync(0, 'utf8').split('\n').filter((line) => line !== '');
    const errors = {};
    for (const file of files)
        errors[file] = await errorsOf(file);
    process.stdout.write(JSON.stringify(errors));
}

main();
