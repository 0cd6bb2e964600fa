// Runs an Open Job Description template (2023-09) on this machine as far as ours use it, and complains about keys that
// the schema of that version does not have: openjd-cli is not among Debian's packages.
//   node openjd_run.mjs TEMPLATE.json       $RETROLUX is the program
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { dirname, resolve } from "node:path";

const file = process.argv[2];
const job = JSON.parse(readFileSync(file, "utf8"));

const known = (object, where, keys) => {
  for (const key of Object.keys(object)) if (!keys.includes(key)) throw Error(`${where}: no key '${key}' in 2023-09`);
};
known(job, "template", ["$schema", "specificationVersion", "extensions", "name", "description", "parameterDefinitions", "jobEnvironments", "steps"]);
if (job.specificationVersion !== "jobtemplate-2023-09") throw Error(`version ${job.specificationVersion}`);
if (!/^.{1,128}$/.test(job.name)) throw Error("name: 1 to 128 characters");

const values = new Map();
for (const p of job.parameterDefinitions) {
  known(p, p.name, ["name", "type", "description", "default", "objectType", "dataFlow", "allowedValues", "userInterface", "minLength", "maxLength"]);
  if (!/^[A-Za-z_][A-Za-z0-9_]{0,63}$/.test(p.name)) throw Error(`parameter name ${p.name}`);
  // A default PATH is relative to the template's folder, and openjd-model refuses one that leads out of it.
  if (p.type === "PATH" && !`${resolve(dirname(file), p.default)}/`.startsWith(`${resolve(dirname(file))}/`))
    throw Error(`${p.name}: references a path outside of the template's folder`);
  values.set(`Param.${p.name}`, p.type === "PATH" ? resolve(dirname(file), p.default) : p.default);
}
values.set("Param.Retrolux", process.env.RETROLUX ?? values.get("Param.Retrolux"));

const fill = (text, more) =>
  text.replace(/{{\s*([\w.]+)\s*}}/g, (_, name) => {
    const value = more.get(name) ?? values.get(name);
    if (value === undefined) throw Error(`no value for ${name}`);
    return value;
  });

const done = new Set();
for (const step of job.steps) {
  known(step, step.name, ["name", "description", "dependencies", "stepEnvironments", "hostRequirements", "parameterSpace", "script"]);
  for (const d of step.dependencies ?? []) if (!done.has(d.dependsOn)) throw Error(`${step.name} before ${d.dependsOn}`);
  const spaces = step.parameterSpace?.taskParameterDefinitions ?? [];
  let tasks = [new Map()];
  for (const p of spaces) {
    const [first, last] = p.range.split("-").map(Number);
    const range = Array.from({ length: last - first + 1 }, (_, i) => first + i);
    tasks = tasks.flatMap((task) => range.map((value) => new Map([...task, [`Task.Param.${p.name}`, String(value)]])));
  }
  const { command, args } = step.script.actions.onRun;
  for (const task of tasks) execFileSync(fill(command, task), args.map((a) => fill(a, task)), { stdio: "inherit" });
  done.add(step.name);
}
