// Asks a running ricochetd from JavaScript by reflection alone, with grpc-js and proto-loader.
// usage: node reflection.js ADDRESS REFLECTION_ADDRESS
"use strict";

const assert = require("node:assert");
const grpc = require("@grpc/grpc-js");
const loader = require("@grpc/proto-loader");
const protobuf = require("protobufjs");
const descriptor = require("protobufjs/ext/descriptor");

const [address, reflectionAddress] = process.argv.slice(2);
const options = {keepCase: true, longs: Number, enums: String};
const deadline = () => new Date(Date.now() + 20000);

// The part of the public reflection protocol that asks for the file of a symbol.
const reflectionProtocol = protobuf.parse(`
  syntax = "proto3";
  message Request { string file_containing_symbol = 4; }
  message Files { repeated bytes file_descriptor_proto = 1; }
  message Response { Files file_descriptor_response = 4; }`, {keepCase: true}).root;

// Returns the package objects that grpc-js makes of what the server says of `symbol`.
function describe(version, symbol) {
  const [Request, Response] = ["Request", "Response"].map((name) => reflectionProtocol.lookupType(name));
  const method = {
    path: `/grpc.reflection.${version}.ServerReflection/ServerReflectionInfo`,
    requestStream: true,
    responseStream: true,
    requestSerialize: (value) => Buffer.from(Request.encode(value).finish()),
    requestDeserialize: (bytes) => Request.decode(bytes),
    responseSerialize: (value) => Buffer.from(Response.encode(value).finish()),
    responseDeserialize: (bytes) => Response.decode(bytes),
  };
  const Client = grpc.makeGenericClientConstructor({info: method}, "ServerReflection");
  const client = new Client(reflectionAddress, grpc.credentials.createInsecure());
  return new Promise((resolve, reject) => {
    const stream = client.info({deadline: deadline()});
    stream.on("error", reject);
    stream.on("data", (response) => {
      const files = response.file_descriptor_response.file_descriptor_proto;
      const set = descriptor.FileDescriptorSet.create({
        file: files.map((bytes) => descriptor.FileDescriptorProto.decode(bytes))});
      stream.end();
      const buffer = Buffer.from(descriptor.FileDescriptorSet.encode(set).finish());
      resolve(grpc.loadPackageDefinition(loader.loadFileDescriptorSetFromBuffer(buffer, options)));
    });
    stream.write({file_containing_symbol: symbol});
  }).finally(() => client.close());
}

function call(Service, method, request) {
  const client = new Service(address, grpc.credentials.createInsecure());
  return new Promise((resolve, reject) => {
    client[method](request, {deadline: deadline()}, (error, answer) => (error ? reject(error) : resolve(answer)));
  }).finally(() => client.close());
}

async function main() {
  for (const version of ["v1", "v1alpha"]) {
    const service = (await describe(version, "ricochet.v1.ImpactService")).ricochet.v1.ImpactService;
    const scene = {
      pendulum: {inertia_kg_m2: 1, a_m: 0.3, b_m: 1, omega_minus_rad_s: -1},
      friction: {kinetic_coefficient: 0.1},
      restitution: {energetic: 1},
    };
    // Lubarda (2009): Newton's coefficient is sqrt((a - mu b)/(a + mu b)) if the energetic one is 1.
    const {outcome} = await call(service, "Solve", {scene});
    assert.ok(Math.abs(outcome.coefficients.newton - Math.sqrt(0.5)) < 1e-15);
    const health = (await describe(version, "grpc.health.v1.Health")).grpc.health.v1.Health;
    const {status} = await call(health, "Check", {service: "ricochet.v1.ImpactService"});
    assert.strictEqual(status, "SERVING");
    console.log(`grpc-js, by reflection ${version}: Solve and Check answer`);
  }
}

main();
