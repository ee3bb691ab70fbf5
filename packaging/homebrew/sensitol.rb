class Sensitol < Formula
  desc "Statistical tolerance analysis for anything you can compute"
  homepage "@REPOSITORY@"
  version "@VERSION@"
  license any_of: ["MIT", "Apache-2.0"]

  on_macos do
    url "@REPOSITORY@/releases/download/v@VERSION@/sensitol-@VERSION@-macos.tar.gz"
    sha256 "@SHA256:macos.tar.gz@"
  end

  on_linux do
    on_intel do
      url "@REPOSITORY@/releases/download/v@VERSION@/sensitol-@VERSION@-x86_64-linux.tar.gz"
      sha256 "@SHA256:x86_64-linux.tar.gz@"
    end
    on_arm do
      url "@REPOSITORY@/releases/download/v@VERSION@/sensitol-@VERSION@-aarch64-linux.tar.gz"
      sha256 "@SHA256:aarch64-linux.tar.gz@"
    end
  end

  def install
    bin.install "bin/sensitol"
    man1.install "share/man/man1/sensitol.1"
    bash_completion.install "share/bash-completion/completions/sensitol"
    zsh_completion.install "share/zsh/site-functions/_sensitol"
    fish_completion.install "share/fish/vendor_completions.d/sensitol.fish"
    pkgshare.install Dir["share/sensitol/*"]
    doc.install Dir["share/doc/sensitol/*"]
  end

  test do
    system bin/"sensitol", "init", "gap"
    assert_match "gap", shell_output("#{bin}/sensitol analyze gap.toml --brief")
  end
end
