{
  description = "Certified proximity queries between convex polyhedra";

  inputs.nixpkgs.url = "github:NixOS/nixpkgs/nixos-unstable";

  outputs =
    { self, nixpkgs }:
    let
      inherit (nixpkgs) lib;
      systems = [ "x86_64-linux" "aarch64-linux" ];
      package =
        pkgs:
        pkgs.stdenv.mkDerivation {
          pname = "swiftprox";
          version = (lib.importTOML ./Cargo.toml).package.version;
          src = self;
          cargoDeps = pkgs.rustPlatform.importCargoLock { lockFile = ./Cargo.lock; };
          # Python writes the manual pages.
          nativeBuildInputs = [ pkgs.cmake pkgs.cargo pkgs.rustc pkgs.rustPlatform.cargoSetupHook pkgs.python3 ];
          cmakeFlags = [ "-DSWIFTPROX_TEST_PEERS=OFF" "-DCMAKE_DISABLE_FIND_PACKAGE_MPI=ON" ];
          doInstallCheck = true;
          installCheckPhase = ''
            $out/bin/swiftprox-query --version
            PKG_CONFIG_PATH=$out/lib/pkgconfig $CC -std=c99 ../examples/hello.c $(${pkgs.pkg-config}/bin/pkg-config --cflags --libs swiftprox) -Wl,-rpath,$out/lib -o hello
            ./hello
          '';
          meta = {
            description = "Certified proximity queries between convex polyhedra";
            license = [ lib.licenses.mit lib.licenses.asl20 ];
            platforms = systems;
            mainProgram = "swiftprox-query";
          };
        };
    in
    {
      packages = lib.genAttrs systems (system: {
        default = package nixpkgs.legacyPackages.${system};
      });
    };
}
